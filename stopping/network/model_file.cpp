#include "stopping/network/model_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <stdexcept>
#include <utility>
#include <vector>

#include "stopping/base/hdf5_file.h"
#include "stopping/base/input_file.h"

namespace lull {

namespace {

// Maps the names of a layer's weights ("kernel", "recurrent_kernel", "bias") to their paths: they
// are the last part of these, between "/" and ":0", whatever scopes come before it.
std::map<std::string, std::string> WeightPaths(const Hdf5Group& layer) {
    std::map<std::string, std::string> paths;
    for (const std::string& path : layer.Strings("weight_names")) {
        const std::string name = path.substr(path.rfind('/') + 1);
        paths[name.substr(0, name.find(':'))] = path;
    }
    return paths;
}

// Reads the weights of one layer. Keras' rows are columns here, so that its arrays arrive
// transposed without being moved.
class LayerReader {
  public:
    LayerReader(const Hdf5Group& root, const std::string& name)
        : name(name), group(root.Group(name)), paths(WeightPaths(group)) {}

    Eigen::MatrixXf Matrix(const std::string& weights, int64_t rows, int64_t columns) const {
        const std::vector<float> values = Read(weights, {rows, columns});
        return Eigen::Map<const Eigen::MatrixXf>(values.data(), columns, rows);
    }
    Eigen::VectorXf Vector(const std::string& weights, int64_t size) const {
        const std::vector<float> values = Read(weights, {size});
        return Eigen::Map<const Eigen::VectorXf>(values.data(), size);
    }
    int64_t Inputs() const {
        const std::vector<int64_t> shape = group.Shape(Path("kernel"));
        return shape.empty() ? 0 : shape[0];
    }

  private:
    const std::string& Path(const std::string& weights) const {
        const auto path = paths.find(weights);
        if (path == paths.end())
            throw std::runtime_error("layer '" + name + "' has no weights called " + weights);
        return path->second;
    }
    std::vector<float> Read(const std::string& weights, const std::vector<int64_t>& shape) const {
        std::vector<float> values = group.Array<float>(Path(weights), shape);
        if (!std::all_of(values.begin(), values.end(), [](float v) { return std::isfinite(v); }))
            throw std::runtime_error("the weights '" + Path(weights) + "' hold NaN or infinity");
        return values;
    }

    std::string name;
    Hdf5Group group;
    std::map<std::string, std::string> paths;
};

Network ReadNetwork(const Hdf5Group& root, const KerasModel& model, int64_t inputs) {
    Network network;
    for (const KerasLayer& layer : model.layers) {
        const LayerReader reader(root, layer.name);
        const int64_t columns = (layer.isLstm ? 4 : 1) * layer.units;
        const Eigen::MatrixXf kernel = reader.Matrix("kernel", inputs, columns);
        const Eigen::VectorXf bias =
            layer.useBias ? reader.Vector("bias", columns) : Eigen::VectorXf::Zero(columns).eval();
        if (layer.isLstm)
            network.lstm.push_back({layer.name, kernel,
                                    reader.Matrix("recurrent_kernel", layer.units, columns), bias,
                                    layer.activation, layer.recurrentActivation});
        else
            network.dense.push_back({layer.name, kernel, bias, layer.activation});
        inputs = layer.units;
    }
    return network;
}

ModelSettings ReadSettings(const Hdf5Group& file, int timeSteps, int64_t inputs) {
    ModelSettings s;
    if (inputs > 1000000) throw std::runtime_error("the network takes too many values");
    if (timeSteps > 0) s.k = timeSteps;
    bool saysM = false;
    if (file.Has("lull")) {
        const Hdf5Group group = file.Group("lull");
        auto read = [&](const char* name, int standard) {
            return group.HasAttribute(name) ? group.Int(name) : standard;
        };
        s.k = read("k", s.k);
        s.n = read("n", s.n);
        saysM = group.HasAttribute("m");
        s.m = read("m", s.m);
        s.snorm = read("snorm", s.snorm) != 0;
        if (read("bnorm", 0) != 0) throw std::runtime_error("bnorm = 1 is not supported");
        s.votes = read("votes", s.votes);
        s.voteSpacing = read("vote_spacing", s.voteSpacing);
        auto readReal = [&](const char* name, double standard) {
            return group.HasAttribute(name) ? group.Real(name) : standard;
        };
        if (group.HasAttribute("spacing")) s.spacing = ParseSpacing(group.String("spacing"));
        s.ratio = readReal("ratio", s.ratio);
        s.visibility = {.mask = readReal("mask", s.visibility.mask),
                        .flare = readReal("flare", s.visibility.flare),
                        .reference = read("reference", s.visibility.reference),
                        .nearness = readReal("nearness", s.visibility.nearness)};
        s.peakLimit = readReal("peak_limit", s.peakLimit);
        if (group.HasAttribute("feature")) s.features = ParseFeatures(group.String("feature"));
        if (group.HasAttribute("pool")) {
            if (group.String("pool") != "mean")
                throw std::runtime_error("pool '" + group.String("pool") +
                                         "' is not supported; mean is");
            s.takesMean = true;
        }
    }
    if (!saysM) s.m = int(inputs);
    CheckSettings(s);
    if (InputCount(s) != inputs || (timeSteps > 0 && s.k != timeSteps))
        throw std::runtime_error("/lull has " + std::to_string(s.k) + " steps of " +
                                 std::to_string(InputCount(s)) + " values, but the network takes " +
                                 (timeSteps > 0 ? std::to_string(timeSteps) : "any number of") +
                                 " steps of " + std::to_string(inputs) + " values");
    return s;
}

void WriteLayer(Hdf5Group root, const std::string& layer,
                const std::vector<std::pair<std::string, Eigen::MatrixXf>>& weights) {
    Hdf5Group group = root.MakeGroup(layer), scope = group.MakeGroup(layer);
    std::vector<std::string> names;
    for (const auto& [name, matrix] : weights) {
        std::vector<int64_t> shape = {matrix.rows()};
        if (name != "bias") shape.insert(shape.begin(), matrix.cols());
        scope.AddArray<float>(name + ":0", shape, {matrix.data(), size_t(matrix.size())});
        names.push_back(layer + "/" + name + ":0");
    }
    group.SetStrings("weight_names", names);
}

void WriteSettings(Hdf5Group group, const ModelSettings& s) {
    group.SetInt("k", s.k);
    group.SetInt("n", s.n);
    group.SetInt("m", s.m);
    group.SetString("feature", FeatureNames(s.features));
    if (s.takesMean) group.SetString("pool", "mean");
    group.SetInt("snorm", s.snorm);
    group.SetInt("votes", s.votes);
    group.SetInt("vote_spacing", s.voteSpacing);
    if (s.spacing == Spacing::Geometric) {
        group.SetString("spacing", SpacingName(s.spacing));
        group.SetReal("ratio", s.ratio);
    }
    if (s.peakLimit > 0) group.SetReal("peak_limit", s.peakLimit);
    if (Needs(s, Feature::VisibleDrop)) {
        group.SetReal("mask", s.visibility.mask);
        group.SetReal("flare", s.visibility.flare);
        group.SetInt("reference", s.visibility.reference);
        group.SetReal("nearness", s.visibility.nearness);
    }
}

void Write(Hdf5Group file, const Network& network, const ModelSettings& s,
           const std::map<std::string, std::string>& record) {
    file.SetString("model_config", WriteKerasConfig(network, s.k));
    Hdf5Group root = file.MakeGroup("model_weights");
    for (Hdf5Group* group : {&file, &root}) {
        group->SetString("keras_version", "2.2.4");
        group->SetString("backend", "tensorflow");
    }
    std::vector<std::string> names;
    for (const LstmLayer& l : network.lstm) {
        WriteLayer(root, l.name,
                   {{"kernel", l.kernel}, {"recurrent_kernel", l.recurrent}, {"bias", l.bias}});
        names.push_back(l.name);
    }
    for (const DenseLayer& l : network.dense) {
        WriteLayer(root, l.name, {{"kernel", l.kernel}, {"bias", l.bias}});
        names.push_back(l.name);
    }
    root.SetStrings("layer_names", names);

    Hdf5Group group = file.MakeGroup("lull");
    WriteSettings(group, s);
    Hdf5Group training = group.MakeGroup("training");
    for (const auto& [name, text] : record) training.SetString(name, text);
}

}  // namespace

Model ReadModel(const std::string& path) {
    Model model;
    model.checksum = FileChecksum(path);
    try {
        const Hdf5Group file = Hdf5Group::Open(path);
        const std::string version =
            file.HasAttribute("keras_version") ? file.String("keras_version") : "";
        const KerasModel config = ParseKerasConfig(file.String("model_config"), version);
        const Hdf5Group root = file.Group("model_weights");
        const int64_t inputs = LayerReader(root, config.layers.front().name).Inputs();
        if (config.inputs > 0 && config.inputs != inputs)
            throw std::runtime_error("the first kernel does not have the shape of the input");
        model.settings = ReadSettings(file, config.timeSteps, inputs);
        model.network = ReadNetwork(root, config, inputs);
        CheckNetwork(model.network);
    } catch (const std::exception& error) {
        throw std::runtime_error(path + ": " + error.what());
    }
    return model;
}

std::map<std::string, std::vector<int>> ReadTrainingBlocks(const std::string& path) try {
    const Hdf5Group file = Hdf5Group::Open(path);
    if (!file.Has("lull") || !file.Group("lull").Has("training")) return {};
    const Hdf5Group training = file.Group("lull").Group("training");
    if (!training.HasAttribute("training_blocks")) return {};
    std::map<std::string, std::vector<int>> blocks;
    std::istringstream lines(training.String("training_blocks"));
    for (std::string line; std::getline(lines, line);) {
        const size_t colon = line.rfind(':');
        if (colon == std::string::npos) continue;  // "none"
        std::istringstream numbers(line.substr(colon + 1));
        for (int block; numbers >> block;) blocks[line.substr(0, colon)].push_back(block);
    }
    return blocks;
} catch (const std::exception& error) {
    throw std::runtime_error(path + ": " + error.what());
}

void WriteModel(const std::string& path, const Network& network, const ModelSettings& settings,
                const std::map<std::string, std::string>& record) {
    CheckNetwork(network);
    CheckSettings(settings);
    const std::string newPath = path + ".new";
    try {
        Hdf5Group file = Hdf5Group::Create(newPath);
        Write(file, network, settings, record);
        file.Flush();
    } catch (const std::exception& error) {
        throw std::runtime_error(newPath + ": " + error.what());
    }
    std::filesystem::rename(newPath, path);
}

using Json = nlohmann::json;

namespace {

constexpr int kMostCount = 16384;  // a bound for damaged files

const std::array<std::pair<const char*, Activation>, 4> activationNames = {
    {{"linear", Activation::Linear},
     {"sigmoid", Activation::Sigmoid},
     {"hard_sigmoid", Activation::HardSigmoid},
     {"tanh", Activation::Tanh}}};

const char* ActivationName(Activation activation) {
    for (const auto& [name, value] : activationNames)
        if (value == activation) return name;
    return "linear";
}

[[noreturn]] void Refuse(const std::string& layer, const std::string& what) {
    throw std::runtime_error("layer '" + layer + "': " + what);
}

int ParseCount(const Json& value, const std::string& what) {
    if (!value.is_number_integer() || value < 0 || value > kMostCount)
        throw std::runtime_error(what + " " + value.dump() + " is not a whole number up to " +
                                 std::to_string(kMostCount));
    return value.get<int>();
}

Activation ParseActivation(const Json& config, const char* key, const char* standard,
                           const std::string& layer, const std::string& version) {
    const Json value = config.contains(key) ? config.at(key) : Json(standard);
    for (const auto& [name, activation] : activationNames) {
        if (value != name) continue;
        // From version 3 on the name stands for clip(x / 6 + 0.5, 0, 1).
        if (activation == Activation::HardSigmoid && version.starts_with("3"))
            Refuse(layer, "hard_sigmoid of Keras " + version + " differs from that of Keras 2");
        return activation;
    }
    Refuse(layer, std::string(key) + " " + value.dump() +
                      " is not supported; linear, sigmoid, hard_sigmoid and tanh are");
}

KerasLayer ParseLayer(const Json& config, bool isLstm, const std::string& version) {
    KerasLayer layer;
    layer.name = config.at("name").get<std::string>();
    layer.isLstm = isLstm;
    layer.units = ParseCount(config.at("units"), "layer '" + layer.name + "': units");
    layer.useBias = config.value("use_bias", true);
    if (layer.units == 0) Refuse(layer.name, "0 units are too few");
    layer.activation =
        ParseActivation(config, "activation", isLstm ? "tanh" : "linear", layer.name, version);
    if (!isLstm) return layer;

    // The default changed from hard_sigmoid to sigmoid between Keras and tf.keras, so that a
    // description without it has no certain meaning.
    if (!config.contains("recurrent_activation"))
        Refuse(layer.name, "recurrent_activation is missing");
    layer.recurrentActivation =
        ParseActivation(config, "recurrent_activation", "", layer.name, version);
    for (const char* option : {"go_backwards", "stateful", "return_state", "time_major"})
        if (config.value(option, false))
            Refuse(layer.name, std::string(option) + " is not supported");
    return layer;
}

void ParseShape(const Json& config, KerasModel* model) {
    for (const char* key : {"batch_input_shape", "batch_shape"}) {
        if (!config.contains(key)) continue;
        const Json& shape = config.at(key);
        if (!shape.is_array() || shape.size() != 3)
            throw std::runtime_error(std::string(key) + " " + shape.dump() +
                                     " is not [null, time steps, values]");
        model->timeSteps = shape[1].is_null() ? 0 : ParseCount(shape[1], key);
        model->inputs = shape[2].is_null() ? 0 : ParseCount(shape[2], key);
    }
}

KerasModel Parse(const Json& json, const std::string& version) {
    if (json.at("class_name") != "Sequential")
        throw std::runtime_error("a model of class " + json.at("class_name").dump() +
                                 " is not supported; Sequential is");
    // Before 2.2.3 the layers were the whole of the model's config.
    const Json& config = json.at("config");
    const Json& layers = config.is_array() ? config : config.at("layers");

    KerasModel model;
    bool givesSequence = true;  // whether the next layer is given a value at every time step
    for (const Json& entry : layers) {
        const std::string kind = entry.at("class_name").get<std::string>();
        const Json& config = entry.at("config");
        const std::string name = config.at("name").get<std::string>();
        if (kind == "InputLayer" && !model.layers.empty())
            Refuse(name, "InputLayer is modelled at the start");
        if (kind == "LSTM" || kind == "InputLayer") ParseShape(config, &model);
        if (kind == "Dropout" || kind == "InputLayer") continue;  // nothing to do when not training
        if (kind != "LSTM" && kind != "Dense")
            Refuse(name, kind + " is not supported; LSTM, Dropout and Dense are");
        if ((kind == "LSTM") != givesSequence)
            Refuse(name, givesSequence ? "Dense on every time step is not supported"
                                       : "an LSTM layer needs one with return_sequences before it");
        model.layers.push_back(ParseLayer(config, kind == "LSTM", version));
        if (kind == "LSTM") givesSequence = config.value("return_sequences", false);
    }
    if (model.layers.empty()) throw std::runtime_error("the model has no layers");
    if (givesSequence) throw std::runtime_error("the last LSTM layer must not return_sequences");
    return model;
}

}  // namespace

KerasModel ParseKerasConfig(const std::string& json, const std::string& version) {
    try {
        return Parse(Json::parse(json), version);
    } catch (const Json::exception& error) {
        throw std::runtime_error(std::string("model_config is not in the format of Keras: ") +
                                 error.what());
    }
}

std::string WriteKerasConfig(const Network& network, int timeSteps) {
    Json layers = Json::array();
    for (const LstmLayer& layer : network.lstm) {
        Json config = {{"name", layer.name},
                       {"trainable", true},
                       {"dtype", "float32"},
                       {"units", layer.Units()},
                       {"return_sequences", &layer != &network.lstm.back()},
                       {"activation", ActivationName(layer.activation)},
                       {"recurrent_activation", ActivationName(layer.recurrentActivation)},
                       {"use_bias", true}};
        if (layers.empty()) config["batch_input_shape"] = {nullptr, timeSteps, layer.Inputs()};
        layers.push_back({{"class_name", "LSTM"}, {"config", config}});
    }
    for (const DenseLayer& layer : network.dense)
        layers.push_back({{"class_name", "Dense"},
                          {"config",
                           {{"name", layer.name},
                            {"trainable", true},
                            {"dtype", "float32"},
                            {"units", layer.bias.size()},
                            {"activation", ActivationName(layer.activation)},
                            {"use_bias", true}}}});
    return Json{{"class_name", "Sequential"},
                {"config", {{"name", "sequential_1"}, {"layers", layers}}}}
        .dump();
}

}  // namespace lull
