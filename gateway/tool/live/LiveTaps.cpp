#include "live/LiveTaps.h"

#include <rabit/SystemTimeClock.h>
#include <rabit/dynamic/DynamicType.h>
#include <rabit/gateway/NamePattern.h>
#include <rabit/gateway/QosProfileWords.h>
#include <rabit/gateway/SchemaText.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <chrono>
#include <mutex>
#include <utility>

#include "Output.h"

namespace Rabit::Tool
{
namespace
{

// Returns a time of messages as nanoseconds since 1970 (UTC), by which viewers order them.
std::uint64_t Nanoseconds(double gpsSeconds)
{
    const auto time = SystemTimeClock::GetSystemTimeClock()->GpsTimeSecondsToSystemClockTimepoint(gpsSeconds);
    const std::chrono::nanoseconds since = time.time_since_epoch();
    return since.count() < 0 ? 0 : static_cast<std::uint64_t>(since.count());
}

}  // namespace

// Shows one local message. Several threads may post it.
class LiveTaps::Tap : public std::enable_shared_from_this<Tap>
{
public:
    // A panel's form of the message, in a channel of its own.
    struct Made
    {
        const PanelMapping *Panel = nullptr;
        std::uint32_t Channel = 0;
    };

    Tap(std::shared_ptr<PublishSubscribeMessage> global, const MessageType &type, std::string node,
        const RabitClock &clock, LiveServer &server)
        : _global(std::move(global)),
          _type(type),
          _node(std::move(node)),
          _clock(clock),
          _server(server),
          _copy(_global->GetCopyOfMessage())
    {
    }

    bool Shows(const std::shared_ptr<PublishSubscribeMessage> &global) const { return _global == global; }
    void SetChannel(std::uint32_t channel) { _channel = channel; }
    // `type` converts the message to JSON.
    void SetPanels(std::vector<Made> panels, std::shared_ptr<const DynamicType> type)
    {
        _panels = std::move(panels);
        _dynamic = std::move(type);
    }

    // Shows the last post, if there is one, and all later ones.
    void Begin()
    {
        const std::lock_guard lock(_mutex);
        _connection = RabitScopedConnection(_global->ConnectSomethingPublished(RabitQuickHandler(
            [weak = weak_from_this()]
            {
                if (const auto tap = weak.lock())
                {
                    tap->OnPost();
                }
            })));
        if (_copy->WasPosted())
        {
            Show();
        }
    }

private:
    void OnPost()
    {
        const std::lock_guard lock(_mutex);
        if (_global->FetchMessage(_copy.get()))
        {
            Show();
        }
    }

    void Show()
    {
        std::vector<std::uint8_t> bytes(_type.SerializedSize(*_copy));
        if (bytes.empty() || _type.Serialize(*_copy, bytes) != bytes.size())
        {
            return;
        }
        const std::uint64_t now = Nanoseconds(_clock.GpsTimeSeconds());
        if (!_panels.empty() && _dynamic)
        {
            ShowInPanels(bytes, now);
        }
        _server.Show(_channel, now, std::move(bytes));
    }

    void ShowInPanels(const std::vector<std::uint8_t> &bytes, std::uint64_t now)
    {
        const auto value = _dynamic->ToJson(bytes);
        for (const Made &made : _panels)
        {
            const auto text =
                value ? made.Panel->Show(_node, *value, Nanoseconds(_copy->GetTimeStamp())) : std::nullopt;
            if (text)
            {
                _server.Show(made.Channel, now, {text->begin(), text->end()});
            }
            else if (!std::exchange(_told, true))
            {
                Output::Talk(_node + "/" + made.Panel->Message() + ": " +
                             (value ? made.Panel->WhyNot(*value) : "it is too large to show"));
            }
        }
    }

    const std::shared_ptr<PublishSubscribeMessage> _global;
    const MessageType &_type;
    const std::string _node;
    const RabitClock &_clock;
    LiveServer &_server;
    std::uint32_t _channel = 0;
    std::vector<Made> _panels;
    std::shared_ptr<const DynamicType> _dynamic;
    std::mutex _mutex;
    std::unique_ptr<RabitMessage> _copy;  // guarded by _mutex, as the next
    bool _told = false;
    RabitScopedConnection _connection;
};

LiveTaps::LiveTaps(FleetSession &session, const GatewayConfig &config, const std::vector<std::string> &except,
                   LiveServer &server)
    : _session(session), _except(except), _server(server), _log(server.AddChannel(PanelLog::Channel(), false))
{
    for (const PanelRule &rule : config.Panels)
    {
        _panels.emplace_back(rule);
    }
}

LiveTaps::~LiveTaps() = default;

void LiveTaps::Look()
{
    // The name of a forgotten node's message is removed, and may return with another global copy.
    std::erase_if(_taps,
                  [this](const auto &entry)
                  {
                      const auto global = _session.Workspace().FindGlobalMessage(entry.first);
                      return !global || (entry.second && !entry.second->Shows(global));
                  });
    for (const MessageInfo &message : _session.Workspace().GetListOfMessages())
    {
        if (message.Name.find('/') != std::string::npos && _taps.count(message.Name) == 0 &&
            !MatchesAny(_except, message.Name))
        {
            const std::shared_ptr<Tap> tap = MakeTap(message.Name);
            _taps[message.Name] = tap;
            if (tap)
            {
                tap->Begin();
            }
        }
    }
    TellProblems();
}

std::shared_ptr<LiveTaps::Tap> LiveTaps::MakeTap(const std::string &name)
{
    const auto global = _session.Workspace().FindGlobalMessage(name);
    const auto copy = global ? global->GetCopyOfMessage() : nullptr;
    const MessageType *type = copy ? MessageTypeRegistry::Of(*copy) : nullptr;
    if (type == nullptr)
    {
        return nullptr;
    }
    const std::string node = name.substr(0, name.find('/'));
    const std::string message = name.substr(name.find('/') + 1);
    const bool isState = IsState(node, message);
    auto tap = std::make_shared<Tap>(global, *type, node, _session.Workspace().GetClock(), _server);
    LiveProtocol::Channel channel;
    channel.Topic = name;
    channel.SchemaName = type->Name();
    channel.SchemaText = SchemaText(type->IdlText());
    tap->SetChannel(_server.AddChannel(std::move(channel), isState));
    std::vector<Tap::Made> made;
    for (const PanelMapping &panel : _panels)
    {
        if (panel.Message() == message)
        {
            made.push_back({&panel, _server.AddChannel(panel.ChannelFor(node), isState)});
        }
    }
    if (!made.empty())
    {
        tap->SetPanels(std::move(made), DynamicType::Parse(type->IdlText(), type->Name()).Type);
    }
    return tap;
}

bool LiveTaps::IsState(const std::string &node, const std::string &message) const
{
    for (const FleetSession::Node &one : _session.Nodes())
    {
        if (one.Name != node || !one.Offers)
        {
            continue;
        }
        for (const Gateway::PublishedMessage &published : one.Offers->publishes)
        {
            if (published.message == message)
            {
                return ProfileOf(published.qos) == QosProfile::State;
            }
        }
    }
    return true;  // a message of this program, such as Gateway/Fleet
}

void LiveTaps::TellProblems()
{
    constexpr int info = 2;
    constexpr int warning = 3;
    std::set<std::string> problems;
    for (const Gateway::Problem &problem : _session.Fleet().problems)
    {
        problems.insert(problem.subject + ": " + problem.reason);
    }
    const std::uint64_t now = Nanoseconds(_session.Workspace().GetClock().GpsTimeSeconds());
    const auto tell = [&](int level, const std::string &text)
    {
        const std::string line = PanelLog::Line(now, level, "Gateway", text);
        _server.Show(_log, now, {line.begin(), line.end()});
    };
    for (const std::string &text : problems)
    {
        if (_problems.count(text) == 0)
        {
            tell(warning, text);
        }
    }
    for (const std::string &text : _problems)
    {
        if (problems.count(text) == 0)
        {
            tell(info, "no more: " + text);
        }
    }
    _problems = std::move(problems);
}

}  // namespace Rabit::Tool
