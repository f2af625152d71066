#include "stopping/network/keras_config.h"

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

namespace lull {

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

// Reads a whole number from 0 to `kMostCount`. (JSON has numbers that no int can hold.)
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

// Takes the shape of the input, [null, time steps, values], where a layer gives one.
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
