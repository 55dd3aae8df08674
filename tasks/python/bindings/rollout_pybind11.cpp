#include <pybind11/stl.h>

#include "pincer/tasks/python/bindings/bindings.h"
#include "pincer/tasks/python/bindings/objects.h"
#include "pincer/tasks/python/bindings/views_pybind11.h"

namespace pincer::python {
namespace {

using Models = std::vector<std::shared_ptr<Model>>;
using Doubles = py::array_t<double, py::array::c_style>;
using Flags = py::array_t<std::int32_t, py::array::c_style>;

// States that a rollout has for its time; given back whatever happens.
class Lent {
 public:
  explicit Lent(const std::vector<State*>& states) {
    try {
      for (State* state : states) {
        scenes.push_back(&state->lend());
        states_.push_back(state);
      }
    } catch (...) {
      giveBack();
      throw;
    }
  }
  ~Lent() { giveBack(); }
  Lent(const Lent&) = delete;
  Lent& operator=(const Lent&) = delete;

  std::vector<tasks::SceneState*> scenes;

 private:
  void giveBack() {
    for (State* state : states_) state->takeBack();
    states_.clear();
  }
  std::vector<State*> states_;
};

void checkModels(const Models& models, const std::vector<State*>& states) {
  for (std::size_t i = 0; i < states.size(); ++i) {
    const Model& model = *models[models.size() == 1 ? 0 : i];
    if (&states[i]->model() != &model) throw InputError(fmt::format("rollout: states[{}] isn't one of its model.", i));
  }
}

template <class Array>
auto spanOf(std::optional<Array>& array) {
  using Number = typename Array::value_type;
  return array ? std::span<Number>(array->mutable_data(), static_cast<std::size_t>(array->size()))
               : std::span<Number>();
}

// Shapes have been checked by rollout.py, which makes what isn't given. The states are left after their last tick.
void run(tasks::RolloutPool& pool, const Models& models, const std::vector<State*>& states, std::int64_t nstep,
         std::optional<Doubles> controls, std::optional<Doubles> state, std::optional<Doubles> sensors,
         std::optional<Flags> status, std::int64_t chunk_size) {
  checkModels(models, states);
  Lent lent(states);
  tasks::RolloutJob job;
  job.models.assign(models.begin(), models.end());
  job.states = lent.scenes;
  job.ticks = nstep;
  if (controls) job.controls = {controls->data(), static_cast<std::size_t>(controls->size())};
  job.state = spanOf(state);
  job.sensors = spanOf(sensors);
  job.status = spanOf(status);
  job.chunk = chunk_size;
  const bool whole = [&] {
    const py::gil_scoped_release no_gil;
    return pool.run(job, interruptedByUser);
  }();
  if (!whole) throw py::error_already_set();
}

}  // namespace

void bindRollout(py::module_& module) {
  py::class_<tasks::RolloutPool>(module, "Pool")
      .def(py::init<int>(), py::arg("threads"))
      .def_property_readonly("threads", &tasks::RolloutPool::threads)
      .def("run", &run, py::arg("models"), py::arg("states"), py::arg("nstep"), py::arg("controls").noconvert(),
           py::arg("state").noconvert(), py::arg("sensors").noconvert(), py::arg("status").noconvert(),
           py::arg("chunk_size"));
}

}  // namespace pincer::python
