// node NAME OTHER TRANSPORT DOMAIN: sends readings to the other node. Prints a line when it has all of the
// other's readings and knows that its own arrived. Ends on SIGTERM, because the other node may still wait
// for acknowledgements.
#include <rabit/RabitManager.h>
#include <rabit/RabitReactor.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/transport/TransportFactory.h>

#include <deque>
#include <exception>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>

#include "consumer.idl.h"
#include "wind_msgs/msg/Wind.idl.h"

namespace
{

constexpr std::uint32_t Readings = 200;
// A message of a package of ROS 2.
static_assert(wind_msgs::msg::Wind_Constants::CALM == 0);

class Exchange : public Rabit::RabitManager
{
public:
    Exchange(const std::string &name, const std::string &other)
        : RabitManager("Exchange"), _name(name), _address(other + "/Exchange")
    {
        SetWakeupTimeDelaySec(0.01);
    }

    void ExecuteUnitOfWork() final
    {
        Send();
        Receive();
        if (!_done && _received == Readings && AllDelivered())
        {
            _done = true;
            std::cout << _name << " has all of " << _address << std::endl;
        }
    }

private:
    void Send()
    {
        while (_sent < Readings)
        {
            auto reading = std::make_shared<Consumer::Reading>();
            reading->sensor = _name;
            reading->number = _sent + 1;
            auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
            if (!AddMessageToQueue(_address, reading, receipt))
            {
                return;  // the other node is not there yet
            }
            ++_sent;
            _receipts.push_back(receipt);
        }
    }

    void Receive()
    {
        std::shared_ptr<Rabit::RabitMessage> message;
        while (GetManagerMessageQueue()->GetMessage(message))
        {
            const auto reading = std::dynamic_pointer_cast<Consumer::Reading>(message);
            if (!reading || reading->number != _received + 1)
            {
                throw std::runtime_error("a reading is missing or came twice");
            }
            ++_received;
        }
    }

    bool AllDelivered()
    {
        while (!_receipts.empty() && _receipts.front()->Outcome() == Rabit::QueueOutcome::Delivered)
        {
            _receipts.pop_front();
        }
        return _sent == Readings && _receipts.empty();
    }

    const std::string _name;
    const std::string _address;
    std::uint32_t _sent = 0;
    std::uint32_t _received = 0;
    bool _done = false;
    std::deque<std::shared_ptr<Rabit::RabitQueueReceipt>> _receipts;
};

}  // namespace

int main(int argc, char **argv)
try
{
    if (argc != 5)
    {
        std::cerr << "usage: node NAME OTHER TRANSPORT DOMAIN" << std::endl;
        return 2;
    }
    Rabit::GatewayConfig config;
    config.Node = argv[1];
    config.Domain = std::stoi(argv[4]);
    config.Interfaces = {"127.0.0.1"};
    config.Accept.push_back({"Exchange", {"Consumer::Reading"}});

    Rabit::RabitReactor reactor;
    reactor.AddManager(std::make_unique<Exchange>(argv[1], argv[2]));
    reactor.AddManager(std::make_unique<Rabit::GatewayManager>(config, Rabit::MakeTransport(argv[3])));
    reactor.Run();
    return 0;
}
catch (const std::exception &error)
{
    std::cerr << "node: " << error.what() << std::endl;
    return 2;
}
