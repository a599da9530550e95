// A node that prints the messages and states of its configuration's foreign topics, and posts and sends to
// these topics. Usage: foreign_node CONFIG, until SIGTERM
//   message LOCAL VALUE AGE    queue LOCAL VALUE    foreign TOPIC STATE [REASON]
#include <rabit/RabitManager.h>
#include <rabit/RabitMessageQueue.h>
#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/gateway/LoadGatewayConfig.h>

#include <CLI/CLI.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "TestNode.h"
#include "px4_msgs/msg/TrajectorySetpoint.idl.h"
#include "std_msgs/msg/String.idl.h"

namespace
{

using Queue = Rabit::RabitMessageQueue<std::shared_ptr<Rabit::RabitMessage>>;
using px4_msgs::msg::TrajectorySetpoint;
using std_msgs::msg::String;

std::string ValueOf(const Rabit::RabitMessage &message)
{
    if (const auto *setpoint = dynamic_cast<const TrajectorySetpoint *>(&message))
    {
        return std::to_string(setpoint->timestamp);
    }
    return dynamic_cast<const String &>(message).data;
}

class Watcher : public Rabit::RabitManager
{
public:
    explicit Watcher(const Rabit::GatewayConfig &config) : RabitManager("Watcher")
    {
        SetWakeupTimeDelaySec(0.05);
        AddPublishSubscribeMessage(Rabit::FleetMessageNameOf(config), _fleet);
        WakeUpManagerOnMessagePost(_fleet);
        for (const Rabit::ForeignRule &rule : config.Foreign)
        {
            if (rule.Way == Rabit::ForeignRule::Direction::Publish &&
                rule.Local.find('/') != std::string::npos)
            {
                continue;  // a mirrored message, which others post
            }
            if (rule.Way == Rabit::ForeignRule::Direction::Publish &&
                rule.Each == Rabit::ForeignRule::Delivery::Queue)
            {
                _written.push_back(rule.Local);
                continue;
            }
            if (rule.Each == Rabit::ForeignRule::Delivery::Queue)
            {
                _queues[rule.Local] = std::make_shared<Queue>(1000, rule.Local);
                AddManagerMessageQueue(rule.Local, _queues[rule.Local]);
                WakeUpManagerOnEnqueue(_queues[rule.Local]);
                continue;
            }
            std::shared_ptr<Rabit::RabitMessage> message;
            if (rule.Type == "std_msgs::msg::String")
            {
                message = std::make_shared<String>();
            }
            else
            {
                message = std::make_shared<TrajectorySetpoint>();
            }
            AddPublishSubscribeMessage(rule.Local, message);
            const bool posts = rule.Way == Rabit::ForeignRule::Direction::Publish;
            (posts ? _posted : _read)[rule.Local] = message;
        }
    }

    void ExecuteUnitOfWork() final
    {
        for (const auto &[name, message] : _read)
        {
            if (message->FetchMessage() && message->WasPosted())
            {
                std::cout << "message " << name << ' ' << ValueOf(*message) << ' ' << message->GetAgeSeconds()
                          << std::endl;
            }
        }
        for (const auto &[name, queue] : _queues)
        {
            std::shared_ptr<Rabit::RabitMessage> message;
            while (queue->GetMessage(message))
            {
                std::cout << "queue " << name << ' ' << ValueOf(*message) << std::endl;
            }
        }
        if (_fleet->FetchMessage())
        {
            TellStates();
        }
        if (IsTurn())
        {
            Post();
        }
    }

private:
    void TellStates()
    {
        for (const Rabit::Gateway::ForeignTopic &topic : _fleet->foreign)
        {
            std::string text = "foreign " + topic.topic + ' ' + ToString(topic.state);
            text += (topic.reason.empty() ? "" : " ") + topic.reason;
            if (_said[topic.topic + topic.local] != text)
            {
                _said[topic.topic + topic.local] = text;
                std::cout << text << std::endl;
            }
        }
    }

    void Post()
    {
        ++_number;
        for (const auto &[name, message] : _posted)
        {
            if (auto *setpoint = dynamic_cast<TrajectorySetpoint *>(message.get()))
            {
                setpoint->timestamp = _number;
                setpoint->position = {1, 2, -5};
            }
            else
            {
                dynamic_cast<String &>(*message).data = std::to_string(_number);
            }
            message->PostMessage();
        }
        for (const std::string &queue : _written)
        {
            auto message = std::make_shared<String>();
            message->data = std::to_string(_number);
            AddMessageToQueue(queue, message);
        }
    }

    std::shared_ptr<Rabit::Gateway::Fleet> _fleet = std::make_shared<Rabit::Gateway::Fleet>();
    std::map<std::string, std::shared_ptr<Rabit::RabitMessage>> _read;
    std::map<std::string, std::shared_ptr<Rabit::RabitMessage>> _posted;
    std::map<std::string, std::shared_ptr<Queue>> _queues;
    std::vector<std::string> _written;  // queues
    std::map<std::string, std::string> _said;
    std::uint64_t _number = 0;
};

}  // namespace

int main(int argc, char **argv)
{
    CLI::App app{"A node with foreign topics"};
    std::string file;
    app.add_option("config", file)->required();
    return TestNode::Main(app, argc, argv,
                          [&]
                          {
                              const Rabit::GatewayConfig config = Rabit::LoadGatewayConfig(file);
                              std::vector<std::unique_ptr<Rabit::RabitManager>> managers;
                              managers.push_back(std::make_unique<Watcher>(config));
                              TestNode::Run(config, std::move(managers));
                          });
}
