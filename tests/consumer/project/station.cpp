// station [--config station.yaml]: measures the wind ten times a second, and obeys orders at once.
#include <rabit/RabitManager.h>
#include <rabit/node/RunNode.h>

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
        SetPeriodSec(0.1);            // measures ten times a second, however many orders come
        SetWakeupBetweenTurns(true);  // and an order does not wait for the next turn
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
        if (IsTurn())
        {
            Measure();
        }
    }

private:
    void Measure()
    {
        _wind->speed = 5.0 * _factor;  // read an instrument here
        _wind->direction = 270.0;
        ++_wind->number;
        _wind->PostMessage();
    }

    std::shared_ptr<Weather::Wind> _wind = std::make_shared<Weather::Wind>();
    double _factor = 1.0;
};

}  // namespace

int main(int argc, char **argv)
{
    return Rabit::RunNode(argc, argv, "station.yaml",
                          [](Rabit::RabitReactor &reactor)
                          { reactor.AddManager(std::make_unique<Station>()); });
}
