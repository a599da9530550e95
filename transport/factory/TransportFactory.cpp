#include <rabit/transport/TransportFactory.h>

#ifdef RABIT_WITH_CYCLONEDDS
#include <rabit/cyclonedds/CycloneDdsTransport.h>
#endif
#ifdef RABIT_WITH_FASTDDS
#include <rabit/fastdds/FastDdsTransport.h>
#endif

#include <map>

namespace Rabit
{

namespace
{

using Maker = std::unique_ptr<Transport> (*)();

const std::map<std::string, Maker> &Makers()
{
    static const std::map<std::string, Maker> makers = {
#ifdef RABIT_WITH_CYCLONEDDS
        {"cyclonedds", [] { return std::unique_ptr<Transport>(std::make_unique<CycloneDdsTransport>()); }},
#endif
#ifdef RABIT_WITH_FASTDDS
        {"fastdds", [] { return std::unique_ptr<Transport>(std::make_unique<FastDdsTransport>()); }},
#endif
    };
    return makers;
}

// The backends that exist, and the build option of each.
const std::map<std::string, std::string> OptionOf = {{"cyclonedds", "RABIT_WITH_CYCLONEDDS"},
                                                     {"fastdds", "RABIT_WITH_FASTDDS"}};

}  // namespace

std::unique_ptr<Transport> MakeTransport(const std::string &name)
{
    const auto maker = Makers().find(name);
    if (maker != Makers().end())
    {
        return maker->second();
    }
    std::string built;
    for (const auto &available : AvailableTransports())
    {
        built += (built.empty() ? "" : ", ") + available;
    }
    const auto option = OptionOf.find(name);
    const std::string why = option != OptionOf.end() ? "this build is without the transport " + name + " (" +
                                                           option->second + " is off)"
                                                     : "there is no transport called " + name;
    throw TransportError(why + "; it has: " + (built.empty() ? "none" : built), "transport");
}

std::vector<std::string> KnownTransports()
{
    std::vector<std::string> names;
    for (const auto &[name, option] : OptionOf)
    {
        names.push_back(name);
    }
    return names;
}

std::vector<std::string> AvailableTransports()
{
    std::vector<std::string> names;
    for (const auto &[name, maker] : Makers())
    {
        names.push_back(name);
    }
    return names;
}

}  // namespace Rabit
