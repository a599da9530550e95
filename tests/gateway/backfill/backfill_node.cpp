// A node for tests of backfill. With `--rate` it posts the telemetry Sample and, ten times more seldom, the
// state Finding. With `--commands` it sends commands to these nodes, and prints how long they took; it also
// prints the ages of the samples that it has. A line begins with `age`, `command` or `posted`.
#include <rabit/RabitManager.h>
#include <rabit/gateway/FleetValues.h>
#include <rabit/node/RunNode.h>

#include <CLI/CLI.hpp>

#include <iostream>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "backfill_test.idl.h"

namespace
{

struct Settings
{
    double Rate = 0;
    std::uint32_t Posts = 1'000'000'000;
    std::size_t Padding = 80;
    std::vector<std::string> Commands;
};

class Poster final : public Rabit::RabitManager
{
public:
    explicit Poster(const Settings &settings)
        : RabitManager("Commands"), _posts(settings.Posts), _padding(settings.Padding)
    {
        AddPublishSubscribeMessage("Sample", _sample);
        AddPublishSubscribeMessage("Finding", _finding);
        SetPeriodSec(1.0 / settings.Rate);
    }

    void ExecuteUnitOfWork() final
    {
        for (std::shared_ptr<Rabit::RabitMessage> message; GetManagerMessageQueue()->GetMessage(message);)
        {
            message.reset();
        }
        if (_sample->number >= _posts)
        {
            return;
        }
        Post(*_sample);
        if (_sample->number % 10 == 0)
        {
            Post(*_finding);
        }
        std::cout << "posted " << _sample->number << std::endl;
    }

private:
    void Post(BackfillTest::Sample &sample) const
    {
        ++sample.number;
        sample.padding.resize(_padding);
        for (std::size_t i = 0; i < sample.padding.size(); ++i)
        {
            sample.padding[i] = static_cast<std::uint8_t>(sample.number * 31 + i * i);
        }
        sample.PostMessage();
    }

    const std::uint32_t _posts;
    const std::size_t _padding;
    std::shared_ptr<BackfillTest::Sample> _sample = std::make_shared<BackfillTest::Sample>();
    std::shared_ptr<BackfillTest::Sample> _finding = std::make_shared<BackfillTest::Sample>();
};

class Commander final : public Rabit::RabitManager
{
public:
    explicit Commander(const Settings &settings) : RabitManager("Commander"), _nodes(settings.Commands)
    {
        SetWakeupTimeDelaySec(0.1);
    }

    void ExecuteUnitOfWork() final
    {
        const auto now = GetWorkspace().GetClock().Monotonic();
        for (const std::string &node : _nodes)
        {
            Sent &sent = _sent[node];
            if (sent.Receipt && sent.Receipt->Outcome() != Rabit::QueueOutcome::Pending)
            {
                std::cout << "command " << node << ' ' << sent.Receipt->Outcome() << ' '
                          << std::chrono::duration<double>(now - sent.At).count() << std::endl;
                sent.Receipt.reset();
            }
            if (!sent.Receipt && now >= sent.At + std::chrono::seconds(1))
            {
                auto command = std::make_shared<BackfillTest::Command>();
                command->number = ++_number;
                auto receipt = std::make_shared<Rabit::RabitQueueReceipt>();
                WakeUpManagerOnOutcome(receipt);
                sent.At = now;
                if (AddMessageToQueue(node + "/Commands", command, receipt))
                {
                    sent.Receipt = std::move(receipt);
                }
            }
        }
        _samples.Fetch();
        for (const auto &[node, sample] : _samples.YoungerThan(1e6))
        {
            std::cout << "age " << node << ' ' << sample->GetAgeSeconds() << std::endl;
        }
    }

private:
    struct Sent
    {
        std::shared_ptr<Rabit::RabitQueueReceipt> Receipt;
        std::chrono::nanoseconds At{0};
    };

    const std::vector<std::string> _nodes;
    std::map<std::string, Sent> _sent;
    std::uint32_t _number = 0;
    Rabit::FleetValues<BackfillTest::Sample> _samples{*this, "Sample"};
};

}  // namespace

int main(int argc, char **argv)
{
    Settings settings;
    Rabit::NodeProgram program;
    program.AddOptions = [&settings](CLI::App &app)
    {
        app.add_option("--rate", settings.Rate, "Posts a second");
        app.add_option("--posts", settings.Posts, "Posts after which it is silent");
        app.add_option("--padding", settings.Padding, "Bytes in each");
        app.add_option("--commands", settings.Commands, "Nodes that get a command a second");
    };
    program.AddManagers = [&settings](Rabit::RabitReactor &reactor, Rabit::GatewayConfig &)
    {
        if (settings.Rate > 0)
        {
            reactor.AddManager(std::make_unique<Poster>(settings));
        }
        if (!settings.Commands.empty())
        {
            reactor.AddManager(std::make_unique<Commander>(settings));
        }
    };
    return Rabit::RunNode(argc, argv, program);
}
