// rabit._rabit, the extension module below the package rabit. Its functions are described in
// rabit/_rabit.pyi.
#include "Module.h"

#include <rabit/RabitLog.h>
#include <rabit/RabitVersion.h>
#include <rabit/gateway/ConfigError.h>
#include <rabit/transport/Transport.h>

namespace py = pybind11;

PYBIND11_MODULE(_rabit, module)
{
    module.attr("__version__") = RABIT_VERSION_STRING;
    static py::exception<Rabit::ConfigError> configError(module, "ConfigError", PyExc_ValueError);
    py::register_exception_translator(
        [](std::exception_ptr raised)
        {
            try
            {
                std::rethrow_exception(raised);
            }
            catch (const Rabit::ConfigError &error)
            {
                PyErr_SetString(configError.ptr(), error.what());
            }
            catch (const Rabit::TransportError &error)
            {
                PyErr_SetString(configError.ptr(), error.what());
            }
        });
    module.def("log",
               [](const std::string &text) { Rabit::RabitLog::Write(Rabit::RabitLogLevel::Error, text); });
    module.def("set_log_level",
               [](const std::string &level)
               {
                   using Level = Rabit::RabitLogLevel;
                   Rabit::RabitLog::SetLevel(level == "debug"     ? Level::Debug
                                             : level == "info"    ? Level::Info
                                             : level == "warning" ? Level::Warning
                                             : level == "error"   ? Level::Error
                                                                  : Level::Off);
               });
    Rabit::Python::DefineMessages(module);
    Rabit::Python::DefineAgreement(module);
    Rabit::Python::DefineNode(module);
    Rabit::Python::DefineRecordings(module);
}
