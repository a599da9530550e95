// Sends messages from one node to another within this process, on one thread, over a wire without cost, under
// a clock that the program advances: instructions and allocations are the same in every run. Its arguments
// and its output: Counting.h.
#include "Counting.h"
#include "WiredTransport.h"

#include <rabit/ManualClock.h>
#include <rabit/RabitManager.h>
#include <rabit/RabitSteppedReactor.h>
#include <rabit/RabitWorkspace.h>
#include <rabit/gateway/GatewayManager.h>
#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "bench.idl.h"

namespace Rabit::Bench
{
namespace
{

using ::Bench::Sample;
using namespace std::chrono_literals;

constexpr std::size_t Padding = 80;  // a message of 100 bytes
constexpr auto Step = 50us;

// Takes all that comes, as any manager does.
class Taker final : public RabitManager
{
public:
    explicit Taker(RabitWorkspace &workspace) : RabitManager("Taker", workspace)
    {
        AddPublishSubscribeMessage("a/Note", _note);
        WakeUpManagerOnMessagePost(_note);
    }

    void ExecuteUnitOfWork() override
    {
        if (_note->FetchMessage() && _note->WasPosted())
        {
            ++Taken;
        }
        while (GetManagerMessageQueue()->GetMessage(_message))
        {
            ++Taken;
        }
    }

    std::uint64_t Taken = 0;

private:
    std::shared_ptr<Sample> _note = std::make_shared<Sample>();
    std::shared_ptr<RabitMessage> _message;
};

// A workspace of its own with a gateway.
class Node
{
public:
    Node(const GatewayConfig &config, Wire &wire, std::shared_ptr<ManualClock> clock)
        : Workspace(std::move(clock)), Reactor(Workspace)
    {
        Reactor.AddManager(
            std::make_unique<GatewayManager>(config, std::make_shared<WiredTransport>(wire), Workspace,
                                             [state = std::uint64_t{42}]() mutable { return ++state; }));
    }

    RabitWorkspace Workspace;
    RabitSteppedReactor Reactor;
};

GatewayConfig Sender(QosProfile qos)
{
    GatewayConfig config;
    config.Node = std::string("a");
    config.MaxDatagram = 65000;
    config.Publish.push_back({.Message = "Note", .Type = "Bench::Sample", .Qos = qos});
    return config;
}

GatewayConfig Receiver()
{
    GatewayConfig config;
    config.Node = std::string("b");
    config.MaxDatagram = 65000;
    config.Subscribe.push_back({.Message = "Note", .Type = "Bench::Sample", .From = {"a"}});
    config.Accept.push_back({.Queue = "Taker", .Types = {"Bench::Sample"}});
    return config;
}

// Two nodes that know each other.
class Pair
{
public:
    explicit Pair(QosProfile qos) : _a(Sender(qos), _wire, _clock), _b(Receiver(), _wire, _clock)
    {
        auto taker = std::make_unique<Taker>(_b.Workspace);
        _taker = taker.get();
        _b.Reactor.AddManager(std::move(taker));
        _a.Workspace.AddPublishSubscribeMessage("Note", _note);
        _note->padding.assign(Padding, 0x5a);
        _a.Reactor.Start();
        _b.Reactor.Start();
        for (int i = 0; i < 600; ++i)
        {
            Advance(5ms);
        }
    }

    void Post()
    {
        ++_note->number;
        _note->PostMessage();
        Advance(Step);
    }

    // Adds several at once, which may share a datagram.
    void AddToQueue(int count)
    {
        for (int i = 0; i < count; ++i)
        {
            ++_note->number;
            if (!_a.Workspace.AddMessageToQueue("b/Taker", _note))
            {
                throw std::runtime_error("refused");
            }
        }
        Advance(Step * count);
    }

    std::uint64_t Taken() const { return _taker->Taken; }

private:
    void Advance(std::chrono::nanoseconds time)
    {
        _clock->Advance(time);
        while (_a.Reactor.RunDue() + _b.Reactor.RunDue() > 0)
        {
        }
    }

    Wire _wire;
    std::shared_ptr<ManualClock> _clock = std::make_shared<ManualClock>(1.4e9, 1000s);
    Node _a;
    Node _b;
    Taker *_taker = nullptr;
    std::shared_ptr<Sample> _note = std::make_shared<Sample>();
};

// The work of any two programs: encode and decode.
class Codec
{
public:
    Codec()
    {
        _in.padding.assign(Padding, 0x5a);
        _buffer.resize(_type.SerializedSize(_in));
    }

    void Run()
    {
        if (_type.Serialize(_in, _buffer) != _buffer.size() || !_type.Deserialize(_buffer, _out))
        {
            throw std::runtime_error("the codec failed");
        }
        ++Count;
    }

    std::uint64_t Count = 0;

private:
    const MessageType &_type = *MessageTypeRegistry::Find("Bench::Sample");
    Sample _in;
    Sample _out;
    std::vector<std::uint8_t> _buffer;
};

Scenario Find(const std::string &name)
{
    if (name == "codec")
    {
        const auto codec = std::make_shared<Codec>();
        return {[codec] { codec->Run(); }, [codec] { return codec->Count; }};
    }
    const auto pair = std::make_shared<Pair>(name == "telemetry" ? QosProfile::Telemetry : QosProfile::State);
    const auto count = [pair] { return pair->Taken(); };
    if (name == "state" || name == "telemetry")
    {
        return {[pair] { pair->Post(); }, count};
    }
    if (name == "queue")
    {
        return {[pair] { pair->AddToQueue(1); }, count};
    }
    if (name == "packed-queue")
    {
        return {[pair] { pair->AddToQueue(64); }, count, 64};
    }
    throw std::invalid_argument("there is no scenario " + name);
}

}  // namespace
}  // namespace Rabit::Bench

int main(int argc, char **argv)
{
    return Rabit::Bench::Count(argc, argv, Rabit::Bench::Find);
}
