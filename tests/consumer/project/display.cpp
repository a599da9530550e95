// display [--config display.yaml]: shows the wind that the station measures, and once has it calibrated.
#include <rabit/RabitManager.h>
#include <rabit/node/RunNode.h>

#include <iostream>
#include <memory>

#include "weather.idl.h"

namespace
{

class Display : public Rabit::RabitManager
{
public:
    Display() : RabitManager("Display")
    {
        AddPublishSubscribeMessage("station/Wind", _wind);
        WakeUpManagerOnMessagePost(_wind);
    }

    void ExecuteUnitOfWork() final
    {
        if (_wind->FetchMessage())
        {
            std::cout << _wind->speed << " m/s from " << _wind->direction << " degrees" << std::endl;
            Calibrate();
        }
    }

private:
    // The station was heard, so it is known by now. If the queue still refuses, the next measurement tries
    // again.
    void Calibrate()
    {
        if (!_calibrated)
        {
            auto order = std::make_shared<Weather::Calibrate>();
            order->factor = 2.0;
            _calibrated = AddMessageToQueue("station/Station", order);
        }
    }

    std::shared_ptr<Weather::Wind> _wind = std::make_shared<Weather::Wind>();
    bool _calibrated = false;
};

}  // namespace

int main(int argc, char **argv)
{
    return Rabit::RunNode(argc, argv, "display.yaml",
                          [](Rabit::RabitReactor &reactor)
                          { reactor.AddManager(std::make_unique<Display>()); });
}
