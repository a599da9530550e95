// rabit log: the log of a node, as it is written.
#include <optional>
#include <string>

#include "Command.h"
#include "FleetSession.h"
#include "LogText.h"
#include "OneNode.h"

namespace Rabit::Tool
{
namespace LogParts
{
namespace
{

using Report = FleetExplorer::Report;

struct Options
{
    CommonOptions Common;
    std::string Node;
    std::uint32_t Lines = 20;
    bool Follow = false;
};

// Reads an answer. Empty: reports that it cannot be read.
std::optional<LogText> Read(const std::string &node, const FleetExplorer::Answer &answer)
{
    std::optional<LogText> log = LogTextOf(answer.Text);
    if (!log)
    {
        Output::Talk(node + " sent a log that makes no sense");
    }
    return log;
}

bool Show(const std::string &node, const LogText &log, bool json)
{
    for (const std::string &line : log.Lines)
    {
        const LogLine parts = LogLineOf(line);
        const bool isRead =
            json ? Output::Object(Json{
                       {"node", node}, {"time", parts.Time}, {"level", parts.Level}, {"text", parts.Text}})
                 : Output::Line(line);
        if (!isRead)
        {
            return false;
        }
    }
    return true;
}

// Follows the log of a node until Ctrl-C.
class Follower
{
public:
    Follower(FleetSession &session, const Options &options, const LogText &before)
        : _session(session), _options(options), _next(before.Next()), _incarnation(Incarnation())
    {
    }

    // Returns the exit code.
    int Run(const Wakeup &wakeup)
    {
        Ask();
        while (!wakeup.IsInterrupted())
        {
            std::optional<FleetExplorer::Answer> answer;
            _session.WaitUntil(FleetSession::Forever,
                               [&]
                               {
                                   LookAtNode();
                                   answer = _session.Explorer().TakeReport(_options.Node, Report::LinesFrom);
                                   return answer.has_value();
                               });
            if (!answer)
            {
                continue;
            }
            const std::optional<LogText> log = Read(_options.Node, *answer);
            if (!log)
            {
                return ProblemFound;
            }
            if (log->First != _next && log->First != 0)
            {
                Output::Talk(std::to_string(log->First - _next) + " lines were overwritten before they came");
            }
            _next = log->Next();
            if (!Show(_options.Node, *log, _options.Common.Json))
            {
                return Good;
            }
            Ask();
        }
        return Good;
    }

private:
    std::uint64_t Incarnation() const
    {
        const auto nodes = _session.Nodes();
        const FleetSession::Node *node = FindNode(nodes, _options.Node);
        return node == nullptr ? 0 : node->Incarnation;
    }

    void Ask() { _session.Explorer().AskForReport(_options.Node, Report::LinesFrom, _next); }

    void LookAtNode()
    {
        const auto nodes = _session.Nodes();
        const FleetSession::Node *node = FindNode(nodes, _options.Node);
        const bool isLost = node == nullptr || node->State == Gateway::NodeState::LOST;
        if (isLost != _isLost)
        {
            _isLost = isLost;
            Output::Talk(_options.Node + (isLost ? " is LOST" : " is there again"));
        }
        if (!isLost && node->Incarnation != _incarnation)
        {
            _incarnation = node->Incarnation;
            _next = 0;
            Output::Talk(_options.Node + " has restarted");
            Ask();
        }
    }

    FleetSession &_session;
    const Options &_options;
    std::uint32_t _next;
    std::uint64_t _incarnation;
    bool _isLost = false;
};

int Run(const Options &options, Wakeup &wakeup)
{
    FleetSession session(ConfigWithoutOffers(options.Common), options.Common, wakeup);
    if (const int code = WaitForNode(session, options.Common, options.Node); code != Good)
    {
        return code;
    }
    const auto answer = Request(session, options.Node, Report::LastLines, options.Lines);
    const std::optional<LogText> log = answer ? Read(options.Node, *answer) : std::nullopt;
    if (!log)
    {
        return ProblemFound;
    }
    const bool isRead = Show(options.Node, *log, options.Common.Json);
    return isRead && options.Follow ? Follower(session, options, *log).Run(wakeup) : Good;
}

}  // namespace
}  // namespace LogParts

void AddLogCommand(CLI::App &app, Chosen &chosen)
{
    using namespace LogParts;
    const auto [command, options] = AddCommand<Options>(app, chosen, "log", "The log of a node", &Run);
    command->add_option("NODE", options->Node, "As uav1")->required();
    AddCommonOptions(*command, options->Common, 5.0);
    command->add_option("-n,--lines", options->Lines, "Number of last lines (default: 20)")
        ->check(CLI::Range(0, 1000));
    command->add_flag("-f,--follow", options->Follow, "Show further lines as they come, until Ctrl-C");
    AddExamples(*command, {"rabit log uav1", "rabit log uav1 -f -n 100", "rabit log uav1 --json"});
}

}  // namespace Rabit::Tool
