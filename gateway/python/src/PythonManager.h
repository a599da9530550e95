// A manager whose unit of work is written in Python.
#pragma once

#include <rabit/RabitManager.h>

#include <pybind11/pybind11.h>

#include <memory>
#include <string>

namespace Rabit::Python
{

// Calls startup, unit_of_work and shutdown of an object of Python, on the manager's own thread, with the GIL.
// An exception is logged there with its traceback, and told in the manager's status as of any manager.
class PythonManager final : public RabitManager
{
public:
    // With the GIL. `period`: seconds; 0: none. Refers to the object weakly until Hold: the object knows its
    // node, and Python finds no cycle that leads through C++.
    PythonManager(std::string name, RabitWorkspace &workspace, const pybind11::object &object, double period);
    ~PythonManager() override;

    // With the GIL. To be called before the manager runs.
    void Hold() { _object = _object(); }

    // Whether this thread is within a call of a manager of that workspace.
    static bool IsCalledIn(const RabitWorkspace &workspace);

    // With the GIL. Points to the manager while it lives, and to nothing after that.
    const std::shared_ptr<PythonManager *> &Self() const { return _self; }

    void Startup() override { Call("startup"); }
    void ExecuteUnitOfWork() override { Call("unit_of_work"); }
    void Shutdown() override { Call("shutdown"); }

private:
    void Call(const char *function);

    pybind11::object _object;  // a weak reference until Hold
    const std::shared_ptr<PythonManager *> _self = std::make_shared<PythonManager *>(this);
};

}  // namespace Rabit::Python
