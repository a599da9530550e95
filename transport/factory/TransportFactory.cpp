#include "Backends.h"

#include <rabit/transport/TransportFactory.h>

namespace Rabit
{

std::unique_ptr<Transport> MakeTransport(const std::string &name)
{
    const auto backend = Backends().find(name);
    if (backend != Backends().end() && backend->second.Maker)
    {
        return backend->second.Maker();
    }
    std::string built;
    for (const auto &available : AvailableTransports())
    {
        built += (built.empty() ? "" : ", ") + available;
    }
    const std::string why = backend != Backends().end() ? "this build is without the transport " + name +
                                                              " (" + backend->second.Option + " is off)"
                                                        : "there is no transport called " + name;
    throw TransportError(why + "; it has: " + (built.empty() ? "none" : built), "transport");
}

std::vector<std::string> KnownTransports()
{
    std::vector<std::string> names;
    for (const auto &[name, backend] : Backends())
    {
        names.push_back(name);
    }
    return names;
}

std::vector<std::string> AvailableTransports()
{
    std::vector<std::string> names;
    for (const auto &[name, backend] : Backends())
    {
        if (backend.Maker)
        {
            names.push_back(name);
        }
    }
    return names;
}

}  // namespace Rabit
