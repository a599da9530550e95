// A node that shows the sensor's readings, and calibrates the sensor after the third.
#include <rabit/RabitManager.h>
#include <rabit/node/RunNode.h>

#include <iostream>
#include <memory>

#include "two_nodes.idl.h"

class Display : public Rabit::RabitManager
{
public:
    Display() : RabitManager("Display")
    {
        AddPublishSubscribeMessage("sensor/Reading", _reading);  // the message Reading of the node sensor
        WakeUpManagerOnMessagePost(_reading);
    }

    void ExecuteUnitOfWork() final  // at once for each reading
    {
        if (_reading->FetchMessage())
        {
            std::cout << "reading " << _reading->number << ": " << _reading->celsius << " C, "
                      << _reading->GetAgeSeconds() << " s old" << std::endl;
            if (++_shown == 3)
            {
                Calibrate();
            }
        }
        if (_receipt && _receipt->Outcome() != Rabit::QueueOutcome::Pending)
        {
            std::cout << "calibration " << _receipt->Outcome()
                      << std::endl;  // in words: calibration delivered
            _receipt.reset();
        }
    }

private:
    void Calibrate()
    {
        auto calibration = std::make_shared<TwoNodes::Calibration>();
        calibration->offset_celsius = -0.5;
        _receipt = std::make_shared<Rabit::RabitQueueReceipt>();  // a receipt for each message
        WakeUpManagerOnOutcome(_receipt);
        AddMessageToQueue("sensor/Sensor", calibration, _receipt);  // the queue Sensor of the node sensor
    }

    std::shared_ptr<TwoNodes::Reading> _reading = std::make_shared<TwoNodes::Reading>();
    std::shared_ptr<Rabit::RabitQueueReceipt> _receipt;
    int _shown = 0;
};

int main(int argc, char **argv)
{
    return Rabit::RunNode(argc, argv, "display.yaml",
                          [](Rabit::RabitReactor &reactor)
                          { reactor.AddManager(std::make_unique<Display>()); });
}
