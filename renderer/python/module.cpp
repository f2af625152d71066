// The extension of the Python module `lull`: the C interface with numpy and exceptions.
#include <lull/lull.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "renderer/python/arrays.h"

namespace py = pybind11;

namespace lull {

namespace {

struct Answer {
    int columns;
    std::vector<lull_answer> blocks;

    template <typename T, typename Field>
    py::array_t<T> Of(Field lull_answer::*field) const {
        return ValuesOf<T>(blocks, columns, field);
    }
    size_t StoppedCount() const {
        return size_t(std::ranges::count(blocks, 1, &lull_answer::stop));
    }
    bool Stop() const { return StoppedCount() == blocks.size(); }
    // Returns None where a number is not known.
    py::object Known(double lull_answer::*field) const {
        for (const lull_answer& block : blocks)
            if (block.*field < 0) return py::none();
        return Of<double>(field);
    }
};

std::string ReprOf(const lull_answer& a) {
    const std::string votes = a.votes_needed > 1
                                  ? py::str("{} of {} votes, ").format(a.votes, a.votes_needed)
                                  : py::str();
    return py::str("<lull.BlockAnswer: {} at {} spp, {}value {:.3g}, threshold {:.3g}>")
        .format(a.stop ? "clean" : "active", a.spp, votes, a.value, a.threshold);
}

constexpr int kDebug = 10, kInfo = 20;  // levels of Python's logging

py::object Logger() { return py::module_::import("logging").attr("getLogger")("lull.stopper"); }

bool IsLogged(int level) { return Logger().attr("isEnabledFor")(level).cast<bool>(); }

// A text with a NUL would silently stand for its beginning in C.
void CheckText(const std::optional<std::string>& text, const char* name) {
    if (text && text->find('\0') != std::string::npos)
        throw py::value_error(std::string(name) + " holds a NUL character");
}

class Stopper {
  public:
    Stopper(int width, int height, const std::optional<std::string>& model,
            const std::optional<std::string>& rule, const std::optional<std::string>& models,
            int block, int passSpp, int cap, double caution)
        : width(width), height(height) {
        if (model && rule) throw py::value_error("model and rule are both given; one is needed");
        if (!(caution > 0)) throw py::value_error("caution must be above 0");
        if (block == 0) throw py::value_error("blocks of 0 pixels");
        CheckText(model, "model");
        CheckText(rule, "rule");
        CheckText(models, "models");
        lull_settings settings = {};
        settings.width = width;
        settings.height = height;
        settings.model = model ? model->c_str() : nullptr;
        settings.rule = rule ? rule->c_str() : nullptr;
        settings.models = models ? models->c_str() : nullptr;
        settings.block = block;
        settings.pass = passSpp;
        settings.cap = cap;
        settings.caution = caution;
        lull_stopper* made = nullptr;
        Check(lull_stopper_create(&settings, &made));
        handle.reset(made, lull_stopper_destroy);
    }

    Answer Observe(const py::array& image, int spp, const std::optional<py::array>& half) {
        const Picture picture(image, half, width, height);
        Answer answer = NoAnswer();
        lull_status status;
        {
            const py::gil_scoped_release others;
            status = lull_stopper_observe(handle.get(), &picture.view, spp, answer.blocks.data());
        }
        Check(status);
        WarnOnce();
        Log(answer, spp);
        return answer;
    }

    lull_answer ObserveBlock(int block, const py::array& image, int spp,
                             const std::optional<py::array>& half) {
        const lull_rect rect = RectOf(block);
        const Picture picture(image, half, rect.width, rect.height);
        lull_answer answer;
        lull_status status;
        {
            const py::gil_scoped_release others;
            status = lull_stopper_observe_block(handle.get(), block, &picture.view, spp, &answer);
        }
        Check(status);
        WarnOnce();
        if (IsLogged(kDebug)) LogBlock(block, answer);
        return answer;
    }

    Answer Last() const {
        Answer answer = NoAnswer();
        for (size_t i = 0; i < answer.blocks.size(); ++i)
            Check(lull_stopper_answer(handle.get(), int(i), &answer.blocks[i]));
        return answer;
    }

    std::vector<std::tuple<int, int, int, int>> Blocks() const {
        std::vector<std::tuple<int, int, int, int>> blocks;
        for (int i = 0; i < lull_stopper_block_count(handle.get()); ++i) {
            const lull_rect rect = RectOf(i);
            blocks.emplace_back(rect.x, rect.y, rect.width, rect.height);
        }
        return blocks;
    }

    py::array_t<bool> Active() const {
        py::array_t<bool> mask({height, width});
        const Answer answer = Last();
        for (size_t i = 0; i < answer.blocks.size(); ++i) {
            const lull_rect rect = RectOf(int(i));
            for (int y = rect.y; y < rect.y + rect.height; ++y)
                std::fill_n(mask.mutable_data(y, rect.x), rect.width, !answer.blocks[i].stop);
        }
        return mask;
    }

    bool Done() const { return lull_stopper_done(handle.get()) == 1; }
    bool NeedsHalf() const { return lull_stopper_needs_half(handle.get()) == 1; }

    py::bytes Save() const {
        size_t size = 0;
        Check(lull_stopper_save(handle.get(), nullptr, &size));
        std::string bytes(size, 0);
        Check(lull_stopper_save(handle.get(), bytes.data(), &size));
        return py::bytes(bytes.data(), size);
    }
    void Restore(const py::bytes& state) {
        const std::string_view bytes = state;
        Check(lull_stopper_restore(handle.get(), bytes.data(), bytes.size()));
    }

    const int width, height;

  private:
    void WarnOnce() {
        const std::string warning = lull_stopper_warning(handle.get());
        if (hasWarned || warning.empty()) return;
        hasWarned = true;
        Warn(warning);
    }
    void Log(const Answer& answer, int spp) const {
        if (IsLogged(kInfo))
            Logger().attr("info")("%d spp: %d of %d blocks are clean", spp, answer.StoppedCount(),
                                  answer.blocks.size());
        if (!IsLogged(kDebug)) return;
        for (size_t i = 0; i < answer.blocks.size(); ++i)
            if (answer.blocks[i].spp == spp) LogBlock(int(i), answer.blocks[i]);
    }
    void LogBlock(int block, const lull_answer& answer) const {
        Logger().attr("debug")("block %d: %s", block, ReprOf(answer));
    }
    lull_rect RectOf(int block) const {
        lull_rect rect;
        Check(lull_stopper_block_rect(handle.get(), block, &rect));
        return rect;
    }
    Answer NoAnswer() const {
        return {lull_stopper_column_count(handle.get()),
                std::vector<lull_answer>(size_t(lull_stopper_block_count(handle.get())))};
    }

    std::shared_ptr<lull_stopper> handle;
    bool hasWarned = false;
};

std::optional<double> Known(double value) {
    return value < 0 ? std::nullopt : std::optional(value);
}

std::string ReprOf(const Answer& answer) {
    const auto [least, most] = std::ranges::minmax(answer.blocks, {}, &lull_answer::spp);
    return py::str("<lull.Answer: {} of {} blocks clean, at {} to {} spp>")
        .format(answer.StoppedCount(), answer.blocks.size(), least.spp, most.spp);
}

std::string ReprOf(const Stopper& stopper) {
    const Answer answer = stopper.Last();
    return py::str("<lull.Stopper of {} x {} pixels: {} of {} blocks clean>")
        .format(stopper.width, stopper.height, answer.StoppedCount(), answer.blocks.size());
}

void BindBlockAnswer(py::module_& module) {
    py::class_<lull_answer>(module, "BlockAnswer", "How it stands with a block.")
        .def_property_readonly("stop", [](const lull_answer& a) { return a.stop == 1; })
        .def_property_readonly("checked", [](const lull_answer& a) { return a.checked == 1; })
        .def_readonly("spp", &lull_answer::spp)
        .def_readonly("next_spp", &lull_answer::next_spp)
        .def_readonly("votes", &lull_answer::votes)
        .def_readonly("votes_needed", &lull_answer::votes_needed)
        .def_readonly("value", &lull_answer::value)
        .def_readonly("threshold", &lull_answer::threshold)
        .def_property_readonly("probability",
                               [](const lull_answer& a) { return Known(a.probability); })
        .def_property_readonly("masked_noise",
                               [](const lull_answer& a) { return Known(a.masked_noise); })
        .def("__repr__", [](const lull_answer& a) { return ReprOf(a); });
}

void BindAnswer(py::module_& module) {
    py::class_<Answer>(module, "Answer",
                       "How it stands with all blocks: arrays of rows x columns. `probability` is "
                       "None for rules that know none, `masked_noise` where no half was shown.")
        .def_property_readonly("stop", &Answer::Stop, "Whether all blocks are clean.")
        .def_property_readonly("stopped",
                               [](const Answer& a) { return a.Of<bool>(&lull_answer::stop); })
        .def_property_readonly("checked",
                               [](const Answer& a) { return a.Of<bool>(&lull_answer::checked); })
        .def_property_readonly("spp", [](const Answer& a) { return a.Of<int>(&lull_answer::spp); })
        .def_property_readonly("next_spp",
                               [](const Answer& a) { return a.Of<int>(&lull_answer::next_spp); })
        .def_property_readonly("votes",
                               [](const Answer& a) { return a.Of<int>(&lull_answer::votes); })
        .def_property_readonly("value",
                               [](const Answer& a) { return a.Of<double>(&lull_answer::value); })
        .def_property_readonly(
            "threshold", [](const Answer& a) { return a.Of<double>(&lull_answer::threshold); })
        .def_property_readonly("probability",
                               [](const Answer& a) { return a.Known(&lull_answer::probability); })
        .def_property_readonly("masked_noise",
                               [](const Answer& a) { return a.Known(&lull_answer::masked_noise); })
        .def("__repr__", [](const Answer& a) { return ReprOf(a); });
}

void BindStopper(py::module_& module) {
    using namespace py::literals;
    py::class_<Stopper>(
        module, "Stopper",
        "Decides on the blocks of an image, from its first samples to its last.\n\n"
        "Args:\n"
        "    width, height: pixels of the image, from 40 to 65,536 each.\n"
        "    model: the name of an installed model ('entropy', the default; 'paper') or a\n"
        "        file.\n"
        "    rule: any other rule of `lull render --stop`, in place of a model.\n"
        "    models: the folder of installed models.\n"
        "    block: pixels a side of the blocks, 40 or more.\n"
        "    pass_spp: the samples per pixel (spp) between two images; 0: they come at any spp.\n"
        "    cap: the most spp, if above 10,000; 0: not known.\n"
        "    caution: from 0.01 to 100; 2 allows half as much visible noise.\n\n"
        "Raises:\n"
        "    ValueError: for a setting out of its range, or an unknown rule.\n"
        "    OSError: for a model or a file that cannot be read.")
        .def(
            py::init<int, int, const std::optional<std::string>&, const std::optional<std::string>&,
                     const std::optional<std::string>&, int, int, int, double>(),
            "width"_a, "height"_a, "model"_a = py::none(), py::kw_only(), "rule"_a = py::none(),
            "models"_a = py::none(), "block"_a = 200, "pass_spp"_a = 0, "cap"_a = 0,
            "caution"_a = 1.0)
        .def("observe", &Stopper::Observe, "image"_a, "spp"_a, "half"_a = py::none(),
             "Checks the image after more samples.\n\n"
             "Args:\n"
             "    image: an array of height x width x 3, float32 (linear; 1 is white) or uint8\n"
             "        (sRGB), with any strides; stopped blocks are not read.\n"
             "    spp: its samples per pixel, more than at the last call.\n"
             "    half: the mean of a fixed half of the samples, for rules that compare it.\n\n"
             "Returns:\n"
             "    An Answer.\n\n"
             "Raises:\n"
             "    ValueError: for another shape or type, invalid values, an spp that "
             "is\n"
             "        not above the last, or a half that is missing. Nothing has changed then.\n\n"
             "Warns:\n"
             "    UserWarning: of values that are not finite, negative or above white, of further\n"
             "        channels, and of images too far apart for the rule ever to stop.")
        .def("observe_block", &Stopper::ObserveBlock, "block"_a, "image"_a, "spp"_a,
             "half"_a = py::none(),
             "Does the same for one block.\n\n"
             "Args:\n"
             "    block: its number, row by row from 0.\n"
             "    image, spp, half: as for observe(), of the block alone.\n\n"
             "Returns:\n"
             "    A BlockAnswer.\n\n"
             "Raises:\n"
             "    ValueError: as observe(), and for an unknown block.")
        .def("answer", &Stopper::Last,
             "Returns the last answer again.\n\nReturns:\n    An Answer; its spp are 0 before the "
             "first image.")
        .def_property_readonly("blocks", &Stopper::Blocks,
                               "The rectangles of the blocks: (x, y, width, height), row by row.")
        .def_property_readonly("active", &Stopper::Active,
                               "An array of height x width: True where more samples are needed.")
        .def_property_readonly("done", &Stopper::Done, "Whether all blocks are clean.")
        .def_property_readonly("needs_half", &Stopper::NeedsHalf,
                               "Whether the rule needs a half buffer.")
        .def("save", &Stopper::Save,
             "Serialises the state, for a checkpoint of the renderer.\n\n"
             "Returns:\n    bytes, which this version on this machine can restore.")
        .def("restore", &Stopper::Restore, "state"_a,
             "Restores a state of save().\n\n"
             "Args:\n    state: bytes of a stopper with the same settings.\n\n"
             "Raises:\n    OSError: if they are damaged or of other settings; nothing has changed "
             "then.")
        .def_readonly("width", &Stopper::width)
        .def_readonly("height", &Stopper::height)
        .def("__repr__", [](const Stopper& s) { return ReprOf(s); });
}

}  // namespace

}  // namespace lull

PYBIND11_MODULE(_lull, module) {
    module.attr("__version__") = lull_version();

    lull::BindBlockAnswer(module);
    lull::BindAnswer(module);
    lull::BindStopper(module);
    lull::BindFunctions(module);
}
