// A library with a type that was generated in C++, and managers, for nodes of Python: what the same reader
// costs in C++, and a source of the messages.
#include <rabit/RabitManager.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayConfig.h>

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <vector>

#include "ping.idl.h"

namespace
{

std::chrono::nanoseconds Now()
{
    return std::chrono::steady_clock::now().time_since_epoch();
}

// Posts 1000 pings a second.
class PingSource final : public Rabit::RabitManager
{
public:
    explicit PingSource(Rabit::RabitWorkspace &workspace) : RabitManager("PingSource", workspace)
    {
        AddPublishSubscribeMessage("Ping", _ping);
        SetPeriodSec(0.001);
    }

    void ExecuteUnitOfWork() final
    {
        _ping->sent_ns = static_cast<std::uint64_t>(Now().count());
        _ping->PostMessage();
    }

private:
    const std::shared_ptr<PythonBench::Ping> _ping = std::make_shared<PythonBench::Ping>();
};

// Notes how late each ping comes. At its end it writes the number of pings and the median in microseconds to
// the file that PING_RESULT names.
class PingReader final : public Rabit::RabitManager
{
public:
    explicit PingReader(Rabit::RabitWorkspace &workspace) : RabitManager("PingReader", workspace)
    {
        AddPublishSubscribeMessage("source/Ping", _ping);
        WakeUpManagerOnMessagePost(_ping);
    }

    void ExecuteUnitOfWork() final
    {
        if (_ping->FetchMessage())
        {
            _late.push_back(std::chrono::duration<double, std::micro>(Now()).count() -
                            1e-3 * static_cast<double>(_ping->sent_ns));
        }
    }

    void Shutdown() final
    {
        const char *file = std::getenv("PING_RESULT");
        if (file != nullptr && !_late.empty())
        {
            std::sort(_late.begin(), _late.end());
            std::ofstream(file) << _late.size() << ' ' << _late[_late.size() / 2] << '\n';
        }
    }

private:
    const std::shared_ptr<PythonBench::Ping> _ping = std::make_shared<PythonBench::Ping>();
    std::vector<double> _late;
};

}  // namespace

// The node `source` gets the source, others get a reader.
extern "C" __attribute__((visibility("default"))) void rabit_add_managers(Rabit::RabitReactor &reactor,
                                                                          Rabit::GatewayConfig &config,
                                                                          Rabit::RabitWorkspace &workspace)
{
    if (config.Node == "source")
    {
        reactor.AddManager(std::make_unique<PingSource>(workspace));
    }
    else
    {
        reactor.AddManager(std::make_unique<PingReader>(workspace));
    }
}
