// station CONFIGURATION: measures the wind ten times a second, and obeys orders.
#include <rabit/RabitManager.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/LoadGatewayConfig.h>
#include <rabit/transport/TransportFactory.h>

#include <exception>
#include <iostream>
#include <memory>

#include "weather.idl.h"

namespace
{

class Station : public Rabit::RabitManager
{
public:
    Station() : RabitManager("Station")  // which is the name of its queue as well
    {
        AddPublishSubscribeMessage("Wind", _wind);
        SetWakeupTimeDelaySec(0.1);
    }

    void ExecuteUnitOfWork() final
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            if (const auto order = std::dynamic_pointer_cast<Weather::Calibrate>(message))
            {
                _factor = order->factor;
            }
        }
        _wind->speed = 5.0 * _factor;  // read an instrument here
        _wind->direction = 270.0;
        ++_wind->number;
        _wind->PostMessage();
    }

private:
    std::shared_ptr<Weather::Wind> _wind = std::make_shared<Weather::Wind>();
    double _factor = 1.0;
};

}  // namespace

int main(int argc, char **argv)
try
{
    const Rabit::GatewayConfig config = Rabit::LoadGatewayConfig(argc > 1 ? argv[1] : "station.yaml");
    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<Station>());
    reactor.AddManager(std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(config.Transport)));
    reactor.Run();  // until Ctrl-C
    return 0;
}
catch (const std::exception &error)
{
    std::cerr << "station: " << error.what() << std::endl;
    return 2;
}
