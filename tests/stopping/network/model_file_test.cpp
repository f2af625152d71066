#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <limits>
#include <stdexcept>
#include <string>

#include "stopping/base/hdf5_file.h"
#include "stopping/base/input_file.h"
#include "stopping/network/model_file.h"
#include "tests/stopping/golden_data.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/scratch_file.h"

namespace lull::model_file_test {
namespace {

TEST(ModelFile, AgreesWithKeras) {
    double worst = 0;
    for (const nlohmann::json& golden : ReadJson(GoldenFile("keras_lstm.json"))) {
        const std::string name = golden["file"];
        const Model model = ReadModel(GoldenFile(name));
        EXPECT_EQ(model.settings.k, golden["k"].get<int>());
        EXPECT_EQ(model.settings.m, golden["m"].get<int>());
        EXPECT_EQ(model.settings.n, 40);  // what the file does not say is the paper's
        EXPECT_EQ(model.settings.votes, 3);
        EXPECT_EQ(model.network.lstm.size(), 3u);
        EXPECT_EQ(model.network.dense.size(), 1u);
        for (size_t i = 0; i < golden["inputs"].size(); ++i) {
            Eigen::MatrixXf sequence(model.settings.m, model.settings.k);
            for (int step = 0; step < model.settings.k; ++step)
                for (int j = 0; j < model.settings.m; ++j)
                    sequence(j, step) = golden["inputs"][i][size_t(step)][size_t(j)].get<float>();
            const double p = RunNetwork(model.network, sequence)[0];
            EXPECT_NEAR(p, golden["outputs"][i].get<double>(), 1e-5) << name << ", input " << i;
            worst = std::max(worst, std::abs(p - golden["outputs"][i].get<double>()));
        }
    }
    RecordProperty("worst", std::to_string(worst * 1e9) + "e-9");
}

TEST(ModelFile, ReadsWhatItWrites) {
    Network network = RandomNetwork(25, {7, 5}, 1e4f);
    network.lstm[0].activation = Activation::Tanh;
    network.lstm[1].recurrentActivation = Activation::Sigmoid;
    network.dense[0].activation = Activation::Linear;
    const ModelSettings settings = {.k = 5,
                                    .n = 60,
                                    .m = 25,
                                    .features = {Feature::H2},
                                    .snorm = false,
                                    .votes = 2,
                                    .voteSpacing = 120};
    const ScratchFile file(".h5");
    WriteModel(file.path, network, settings);
    const Model model = ReadModel(file.path);
    EXPECT_TRUE(model.network == network);
    EXPECT_TRUE(model.settings == settings);
    EXPECT_EQ(model.checksum, FileChecksum(file.path));
    EXPECT_FALSE(std::filesystem::exists(file.path + ".new"));
}

TEST(ModelFile, KeepsFeaturesAndRecords) {
    const ModelSettings settings = {
        .k = 3, .features = {Feature::VisibleDrop, Feature::H}, .takesMean = true};
    const Network network = RandomNetwork(2, {4}, 1);
    const ScratchFile file(".h5");
    WriteModel(file.path, network, settings, {{"seed", "7"}, {"viewpoints", "a: 0 1\nb: 2"}});
    const Model model = ReadModel(file.path);
    EXPECT_TRUE(model.network == network);
    EXPECT_TRUE(model.settings == settings);
    const Hdf5Group record = Hdf5Group::Open(file.path).Group("lull").Group("training");
    EXPECT_EQ(record.String("viewpoints"), "a: 0 1\nb: 2");
}

TEST(ModelFile, TellsTheBlocksItWasTrainedOn) {
    const ScratchFile file(".h5");
    const auto blocksOf = [&](const std::map<std::string, std::string>& record) {
        WriteModel(file.path, RandomNetwork(4, {3}, 1), {.m = 4}, record);
        return ReadTrainingBlocks(file.path);
    };
    EXPECT_EQ(blocksOf({{"training_blocks", "a: 0 1\nb:c: 2"}}),
              (std::map<std::string, std::vector<int>>{{"a", {0, 1}}, {"b:c", {2}}}));
    EXPECT_TRUE(blocksOf({{"training_blocks", "none"}}).empty());
    EXPECT_TRUE(blocksOf({{"seed", "7"}}).empty());
    EXPECT_TRUE(blocksOf({}).empty());
    EXPECT_THROW(ReadTrainingBlocks(file.path + ".no"), std::runtime_error);
}

TEST(ModelFile, KeepsHowNoiseIsSeen) {
    const ScratchFile file(".h5");
    const ModelSettings settings{
        .k = 3,
        .features = {Feature::VisibleDrop},
        .takesMean = true,
        .spacing = Spacing::Geometric,
        .ratio = 1.4,
        .visibility = {.mask = 30, .flare = 0.02, .reference = 5000, .nearness = 0.25},
        .peakLimit = 1.25};
    WriteModel(file.path, RandomNetwork(1, {4}, 1), settings);
    EXPECT_TRUE(ReadModel(file.path).settings == settings);

    // Nothing is said where nothing is meant, so that other models have the bytes they had.
    WriteModel(file.path, RandomNetwork(100, {4}, 1), {});
    const Hdf5Group group = Hdf5Group::Open(file.path).Group("lull");
    for (const char* name : {"spacing", "ratio", "mask", "flare", "reference", "nearness"})
        EXPECT_FALSE(group.HasAttribute(name)) << name;
}

TEST(ModelFile, WritesNoBrokenModel) {
    Network network = RandomNetwork(4, {3}, 1);
    network.lstm[0].bias[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_THROW(WriteModel("/no/such/folder/m.h5", network, {.m = 4}), std::invalid_argument);
    EXPECT_THROW(WriteModel("/no/such/folder/m.h5", RandomNetwork(4, {3}, 1), {.m = 4}),
                 std::runtime_error);
}

// Returns the message of the error that reading the file leads to.
std::string ErrorOf(const std::string& path) {
    return WhatOf([&] { ReadModel(path); });
}

void ExpectError(const std::string& path, const std::string& part) {
    const std::string error = ErrorOf(path);
    EXPECT_TRUE(error.starts_with(path + ": ")) << error;
    EXPECT_HAS(error, part);
}

// Writes a model of one dense layer of one unit after an LSTM layer of one unit, whose weights
// have the given shapes and all the same value.
void WriteSmallModel(const std::string& path, const std::string& config, float value,
                     std::vector<int64_t> kernelShape = {4, 4},
                     const std::function<void(Hdf5Group)>& addSettings = {}) {
    Hdf5Group file = Hdf5Group::Create(path);
    if (addSettings) addSettings(file.MakeGroup("lull"));
    file.SetString("model_config", config);
    Hdf5Group root = file.MakeGroup("model_weights");
    auto write = [&](const std::string& layer, const std::string& name,
                     const std::vector<int64_t>& shape, float x, Hdf5Group group) {
        int64_t size = 1;
        for (int64_t n : shape) size *= n;
        group.AddArray<float>(layer + "/" + name, shape, std::vector<float>(size_t(size), x));
    };
    Hdf5Group lstm = root.MakeGroup("l"), dense = root.MakeGroup("d");
    lstm.MakeGroup("l");
    dense.MakeGroup("d");
    write("l", "kernel:0", kernelShape, value, lstm);
    write("l", "recurrent_kernel:0", {1, 4}, 0.1f, lstm);
    write("l", "bias:0", {4}, 0.1f, lstm);
    lstm.SetStrings("weight_names",
                    std::vector<std::string>{"l/kernel:0", "l/recurrent_kernel:0", "l/bias:0"});
    write("d", "kernel:0", {1, 1}, 0.1f, dense);
    write("d", "bias:0", {1}, 0.1f, dense);
    dense.SetStrings("weight_names", std::vector<std::string>{"d/kernel:0", "d/bias:0"});
}

const std::string smallConfig = WriteKerasConfig(
    [] {
        Network network = RandomNetwork(4, {1}, 1);
        network.lstm[0].name = "l";
        network.dense[0].name = "d";
        return network;
    }(),
    8);

TEST(ModelFile, RefusesWeightsThatAreNotFinite) {
    const ScratchFile file(".h5");
    WriteSmallModel(file.path, smallConfig, 0.5f);
    EXPECT_EQ(ErrorOf(file.path), "");
    for (float bad :
         {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::infinity()}) {
        WriteSmallModel(file.path, smallConfig, bad);
        ExpectError(file.path, "the weights 'l/kernel:0' hold NaN or infinity");
    }
}

TEST(ModelFile, RefusesWeightsOfAnotherShape) {
    const ScratchFile file(".h5");
    WriteSmallModel(file.path, smallConfig, 0.5f, {4, 8});
    ExpectError(file.path, "'l/kernel:0': it does not have the shape 4 x 4");
    WriteSmallModel(file.path, smallConfig, 0.5f, {5, 4});
    ExpectError(file.path, "the first kernel");
}

TEST(ModelFile, RefusesContradictingSettings) {
    const ScratchFile file(".h5");
    WriteModel(file.path, RandomNetwork(4, {3}, 1), {.m = 25});
    ExpectError(file.path, "/lull has 8 steps of 25 values, but the network takes 8 steps of 4");
}

TEST(ModelFile, RefusesSettingsOfNoSense) {
    const ScratchFile file(".h5");
    auto expect = [&](const std::string& error, const std::function<void(Hdf5Group)>& add) {
        WriteSmallModel(file.path, smallConfig, 0.5f, {4, 4}, add);
        ExpectError(file.path, error);
    };
    expect("attribute 'k', which must be an integer", [](Hdf5Group g) { g.SetString("k", "8"); });
    expect("attribute 'feature', which must be text", [](Hdf5Group g) { g.SetInt("feature", 1); });
    expect("feature 'H3' is not known", [](Hdf5Group g) { g.SetString("feature", "H3"); });
    expect("votes = 0 is not in", [](Hdf5Group g) { g.SetInt("votes", 0); });
    // One setting alone leaves the others at their defaults.
    WriteSmallModel(file.path, smallConfig, 0.5f, {4, 4}, [](Hdf5Group g) { g.SetInt("n", 80); });
    EXPECT_EQ(ReadModel(file.path).settings.n, 80);
    EXPECT_TRUE(ReadModel(file.path).settings.snorm);
}

TEST(ModelFile, RefusesFilesCutShort) {
    const ScratchFile whole(".h5"), part(".h5");
    WriteModel(whole.path, RandomNetwork(25, {7, 5}, 1), {.m = 25});
    const std::string bytes = ContentsOf(whole.path);
    for (size_t size = 0; size < bytes.size(); size += 500) {
        std::ofstream(part.path, std::ios::binary) << bytes.substr(0, size);
        EXPECT_NE(ErrorOf(part.path), "") << size;
    }
}

TEST(ModelFile, RefusesOtherFiles) {
    ExpectError("/no/such/file.h5", "No such file");
    const ScratchFile text(".h5", "this is no HDF5 file");
    ExpectError(text.path, "HDF5");
    const ScratchFile empty(".h5");
    { Hdf5Group::Create(empty.path); }
    ExpectError(empty.path, "model_config");
    {
        Hdf5Group file = Hdf5Group::Create(empty.path);
        file.SetString("model_config", smallConfig);
    }
    ExpectError(empty.path, "model_weights");
}

TEST(Checksum, IsTheKnownCrc32) {
    const ScratchFile file(".txt", "123456789");
    EXPECT_EQ(FileChecksum(file.path), "crc32:cbf43926");
    EXPECT_THROW(FileChecksum("/no/such/file"), std::runtime_error);
}

}  // namespace
}  // namespace lull::model_file_test

namespace lull {
namespace {

const std::string lstmLayer =
    R"({"class_name": "LSTM", "config": {"name": "l", "units": 4, "activation": "sigmoid",
        "recurrent_activation": "hard_sigmoid", "batch_input_shape": [null, 8, 100]}})";
const std::string denseLayer =
    R"({"class_name": "Dense", "config": {"name": "d", "units": 1, "activation": "sigmoid"}})";

std::string Sequential(const std::string& layers) {
    return R"({"class_name": "Sequential", "config": {"name": "s", "layers": [)" + layers + "]}}";
}

// Returns `text` with the first `from` replaced.
std::string Replace(std::string text, const std::string& from, const std::string& to) {
    const size_t at = text.find(from);
    return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void ExpectError(const std::string& json, const std::string& part,
                 const std::string& version = "2.2.4") {
    EXPECT_HAS(WhatOf([&] { ParseKerasConfig(json, version); }), part) << json;
}

TEST(KerasConfig, ReadsLayers) {
    const std::string dropout =
        R"({"class_name": "Dropout", "config": {"name": "x", "rate": 0.4}})";
    const KerasModel model =
        ParseKerasConfig(Sequential(lstmLayer + "," + dropout + "," + denseLayer), "2.2.4");
    ASSERT_EQ(model.layers.size(), 2u);
    EXPECT_TRUE(model.layers[0].isLstm);
    EXPECT_EQ(model.layers[0].units, 4);
    EXPECT_EQ(model.layers[0].activation, Activation::Sigmoid);
    EXPECT_EQ(model.layers[0].recurrentActivation, Activation::HardSigmoid);
    EXPECT_FALSE(model.layers[1].isLstm);
    EXPECT_EQ(model.timeSteps, 8);
    EXPECT_EQ(model.inputs, 100);
}

TEST(KerasConfig, ReadsOlderAndNewerForms) {
    // Before 2.2.3 the config was the list of layers; tf.keras adds an input layer.
    const std::string list =
        R"({"class_name": "Sequential", "config": [)" + lstmLayer + "," + denseLayer + "]}";
    EXPECT_EQ(ParseKerasConfig(list, "2.1.6").layers.size(), 2u);
    const std::string input = R"({"class_name": "InputLayer", "config": {"name": "i",
        "batch_input_shape": [null, null, 25]}})";
    const std::string lstm = Replace(lstmLayer, R"(, "batch_input_shape": [null, 8, 100])", "");
    const KerasModel model =
        ParseKerasConfig(Sequential(input + "," + lstm + "," + denseLayer), "2.4.0");
    EXPECT_EQ(model.layers.size(), 2u);
    EXPECT_EQ(model.timeSteps, 0);
    EXPECT_EQ(model.inputs, 25);
}

TEST(KerasConfig, NamesWhatIsNotModelled) {
    const std::string good = Sequential(lstmLayer + "," + denseLayer);
    ExpectError(Replace(good, "Sequential", "Functional"), "Functional");
    ExpectError(Replace(good, "\"LSTM\"", "\"GRU\""), "layer 'l': GRU is not supported");
    ExpectError(Replace(good, "\"Dense\"", "\"BatchNormalization\""), "BatchNormalization");
    ExpectError(Replace(good, "\"sigmoid\"", "\"relu\""), "layer 'l': activation \"relu\"");
    ExpectError(Replace(good, "hard_sigmoid", "softsign"), "recurrent_activation \"softsign\"");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 4, \"go_backwards\": true"),
                "go_backwards");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 4, \"stateful\": true"), "stateful");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 4, \"return_sequences\": true"),
                "Dense on every time step");
    ExpectError(Sequential(denseLayer + "," + lstmLayer), "Dense on every time step");
    ExpectError(Replace(good, "\"LSTM\"", "\"Flatten\""), "Flatten is not supported");
    ExpectError(Sequential(lstmLayer + "," + lstmLayer), "return_sequences");
    ExpectError(good, "hard_sigmoid of Keras 3.1.0", "3.1.0");
}

TEST(KerasConfig, TakesNoShapeAfterTheFirstLayer) {
    const std::string input = R"({"class_name": "InputLayer", "config": {"name": "i",
        "batch_input_shape": [null, null, 25]}})";
    ExpectError(Sequential(lstmLayer + "," + input + "," + denseLayer), "layer 'i': InputLayer");
}

TEST(KerasConfig, RefusesDamagedText) {
    const std::string good = Sequential(lstmLayer + "," + denseLayer);
    ExpectError("", "not in the format of Keras");
    ExpectError("[]", "not in the format of Keras");
    ExpectError(good.substr(0, good.size() / 2), "not in the format of Keras");
    ExpectError(Sequential(""), "no layers");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": \"four\""), "not a whole number");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 0"), "0 units");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 1000000000"), "units");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 4.5"), "units 4.5 is not a whole number");
    ExpectError(Replace(good, "\"units\": 4", "\"units\": 4294967300"), "units 4294967300 is not");
    ExpectError(Replace(good, "[null, 8, 100]", "[null, 100]"), "batch_input_shape");
    ExpectError(Replace(good, "[null, 8, 100]", "[null, 3e117, 100]"), "not a whole number");
    ExpectError(Replace(good, "[null, 8, 100]", "[null, -8, 100]"), "not a whole number");
    ExpectError(Replace(good, R"("recurrent_activation": "hard_sigmoid", )", ""),
                "recurrent_activation is missing");
}

TEST(KerasConfig, ReadsWhatItWrites) {
    const KerasModel model =
        ParseKerasConfig(WriteKerasConfig(RandomNetwork(25, {6, 3}, 1), 5), "2.2.4");
    ASSERT_EQ(model.layers.size(), 3u);
    EXPECT_EQ(model.layers[1].units, 3);
    EXPECT_EQ(model.layers[2].name, "dense_1");
    EXPECT_EQ(model.timeSteps, 5);
    EXPECT_EQ(model.inputs, 25);
}

}  // namespace
}  // namespace lull
