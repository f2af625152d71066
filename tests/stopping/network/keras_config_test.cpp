#include "stopping/network/model_file.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <string>

#include "tests/stopping/network/random_network.h"

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
    try {
        ParseKerasConfig(json, version);
        ADD_FAILURE() << "not refused: " << json;
    } catch (const std::runtime_error& error) {
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
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
