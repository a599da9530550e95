// A library with a type that was generated in C++, and a manager, for nodes of Python: what the same reader
// costs in C++.
#include <rabit/RabitManager.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayConfig.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <fstream>
#include <memory>
#include <vector>

#include "ping.idl.h"

namespace
{

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
            const auto now = std::chrono::steady_clock::now().time_since_epoch();
            _late.push_back(std::chrono::duration<double, std::micro>(now).count() -
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

extern "C" __attribute__((visibility("default"))) void rabit_add_managers(Rabit::RabitReactor &reactor,
                                                                          Rabit::GatewayConfig & /*config*/,
                                                                          Rabit::RabitWorkspace &workspace)
{
    reactor.AddManager(std::make_unique<PingReader>(workspace));
}
