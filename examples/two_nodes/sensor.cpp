// A node that posts a reading once a second, and takes calibrations in its queue.
#include <rabit/RabitManager.h>
#include <rabit/node/RunNode.h>

#include <cmath>
#include <iostream>
#include <memory>

#include "two_nodes.idl.h"

class Sensor : public Rabit::RabitManager
{
public:
    Sensor() : RabitManager("Sensor")  // which is also the name of its queue
    {
        AddPublishSubscribeMessage("Reading", _reading);
        SetPeriodSec(1.0);
    }

    void ExecuteUnitOfWork() final  // once a second
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            if (const auto calibration = std::dynamic_pointer_cast<TwoNodes::Calibration>(message))
            {
                _offset = calibration->offset_celsius;
                std::cout << "calibrated by " << _offset << " C" << std::endl;
            }
        }
        ++_reading->number;
        _reading->celsius = 20.0 + std::sin(0.1 * _reading->number) + _offset;
        _reading->PostMessage();
    }

private:
    std::shared_ptr<TwoNodes::Reading> _reading = std::make_shared<TwoNodes::Reading>();
    double _offset = 0.0;
};

int main(int argc, char **argv)
{
    return Rabit::RunNode(argc, argv, "sensor.yaml",
                          [](Rabit::RabitReactor &reactor)
                          { reactor.AddManager(std::make_unique<Sensor>()); });
}
