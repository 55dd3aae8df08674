#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/objects.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"
#include "pincer/tasks/view/scene_picture.h"

namespace pincer::python {
namespace {

// Pictures of states of one model, of one size; one thread makes and uses it.
class Renderer {
 public:
  Renderer(ModelPointer model, int width, int height)
      : model_(std::move(model)),
        picture_(model_->grasp, tasks::startState(model_->scene, model_->grasp), width, height) {}

  py::array_t<std::uint8_t> render(const State& state, const std::optional<tasks::CameraChoice>& camera, bool forces) {
    if (&state.model() != model_.get()) throw InputError("render: the state is one of another model.");
    const tasks::Image image =
        picture_.draw(state.scene().grasp, state.scratch(), camera.value_or(tasks::CameraChoice{}), forces);
    py::array_t<std::uint8_t> pixels({image.height, image.width, 3});
    std::copy_n(image.bytes.data(), pixels.size(), pixels.mutable_data());
    return pixels;
  }

 private:
  ModelPointer model_;
  tasks::ScenePicture picture_;
};

tasks::CameraChoice cameraOf(const py::object& target, std::optional<double> distance, std::optional<double> yaw,
                             std::optional<double> pitch) {
  tasks::CameraChoice camera{{}, distance, yaw, pitch};
  if (!target.is_none()) camera.target_W = Vec3(numbersOf(target, 3, "camera target (x, y, z)").data());
  return camera;
}

}  // namespace

void bindRender(py::module_& module) {
  py::class_<tasks::CameraChoice>(module, "Camera",
                                  "From where a picture looks; None: as in the window, so that all that moves is seen.")
      .def(py::init(&cameraOf), py::arg("target") = py::none(), py::arg("distance") = py::none(),
           py::arg("yaw") = py::none(), py::arg("pitch") = py::none(),
           "target (x, y, z) that it looks at [m]; distance [m]; yaw about z [rad], 0 looks along +y; pitch over the "
           "horizon [rad], -1.5 "
           ".. 1.5.");
  py::class_<Renderer>(module, "Renderer",
                       "Pictures of states of one model without a display; made and used by one thread.")
      .def(py::init([](std::shared_ptr<Model> model, int width, int height) {
             return std::make_unique<Renderer>(std::move(model), width, height);
           }),
           py::arg("model"), py::arg("width") = 640, py::arg("height") = 480)
      .def("render", &Renderer::render, py::arg("state"), py::arg("camera") = py::none(), py::arg("forces") = true,
           "uint8 array (height, width, 3). Forces and contacts are those of the last step; a snapshot that wasn't "
           "stepped has none.");
}

}  // namespace pincer::python
