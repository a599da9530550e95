#include "PythonManager.h"

#include <stdexcept>

#include "Seconds.h"

namespace Rabit::Python
{

namespace py = pybind11;

namespace
{

// The workspace of the manager that this thread calls.
thread_local const RabitWorkspace *calledIn = nullptr;

}  // namespace

PythonManager::PythonManager(std::string name, RabitWorkspace &workspace, const py::object &object,
                             double period)
    : RabitManager(std::move(name), workspace), _object(py::weakref(object))
{
    if (DurationOf(period).count() > 0)
    {
        SetPeriodSec(period);
        SetWakeupBetweenTurns(true);
    }
}

PythonManager::~PythonManager()
{
    const py::gil_scoped_acquire gil;
    *_self = nullptr;
    _object = py::object();
}

bool PythonManager::IsCalledIn(const RabitWorkspace &workspace)
{
    return calledIn == &workspace;
}

void PythonManager::Call(const char *function)
{
    calledIn = &GetWorkspace();  // the thread is this manager's alone
    const py::gil_scoped_acquire gil;
    std::string problem;
    try
    {
        _object.attr(function)();
        return;
    }
    catch (py::error_already_set &error)
    {
        py::module_::import("rabit._log")
            .attr("exception")("manager " + GetManagerName() + ": " + function, error.type(), error.value(),
                               error.trace());
        // The text is taken while the GIL is held: the exception of Python must not outlive it here.
        problem = py::cast<std::string>(error.type().attr("__name__")) + ": " +
                  py::cast<std::string>(py::str(error.value()));
    }
    throw std::runtime_error(problem);
}

}  // namespace Rabit::Python
