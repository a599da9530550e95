#pragma once

#include <rabit/gateway/Fleet.h>
#include <rabit/gateway/GatewayConfig.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// For programs that look at a fleet whose messages they were not built with. Tells what each node announces,
// gets the IDL text of its types, and subscribes while the gateway runs. GatewayManager::Explorer returns it;
// it lives as long as the gateway. All functions may be called from any thread; the gateway acts on them a
// moment later.
class FleetExplorer
{
public:
    virtual ~FleetExplorer() = default;

    struct Strain
    {
        enum class Kind
        {
            Filling,  // its outbox for the other node is half full or more, or was full lately
            InDoubt,  // messages of it, since the other node restarted before it acknowledged them
            HeldBack  // messages of the other node, since its own queue has been full for some time
        };
        Kind What = Kind::Filling;
        std::string Other;      // the node; empty: this gateway has not heard that node
        unsigned Percent = 0;   // Filling: how full
        unsigned Messages = 0;  // Filling: refused in the last half minute; InDoubt: in it
    };

    struct Node
    {
        std::string Name;
        Gateway::NodeState State = Gateway::NodeState::LOST;
        std::uint64_t Incarnation = 0;
        // Empty: its announcement has not come. Names in it are valid, except those of types, which may be
        // any text.
        std::optional<Gateway::Announcement> Offers;
        bool IsTwice = false;  // another live node has the same name
        // How far its wall clock is ahead of this node's, in seconds, to within half a round trip. NaN: not
        // known.
        double ClockAhead = std::numeric_limits<double>::quiet_NaN();
        // Beats of its present incarnation that came, and that did not, since its first one came.
        std::uint64_t BeatsHeard = 0;
        std::uint64_t BeatsMissed = 0;
        // Seconds from its last beat to the next one, as the last one announces.
        double BeatPeriod = 0.0;
        // Troubles of its queue links to other nodes, as its own beats report them: at most four, the worst
        // first.
        std::vector<Strain> Strains;
        // True if Gateway/Fleet has the node's own problems as it told them last, or that it has none. Always
        // false for nodes that `problems_of` does not name.
        bool AreProblemsKnown = false;
        // True if it told that it hears the nodes that this gateway hears, and no others. For tools alone.
        bool HearsTheSame = false;
    };
    // The other nodes, by name.
    virtual std::vector<Node> Nodes() const = 0;
    // The names of other tools that are heard.
    virtual std::vector<std::string> Tools() const = 0;

    // Asks that node for the text of a type, by the definition hash in its announcement. The gateway repeats
    // the question, ever more seldom, until the text comes or another call names another node for it.
    virtual void AskForType(const std::string &node, const std::string &type, std::uint64_t definition) = 0;
    // The text of that hash, once it has come.
    virtual std::optional<std::string> TypeText(std::uint64_t definition) const = 0;

    // A text that a node writes about itself when it is requested. Names and reasons in it come from the
    // network.
    enum class Report
    {
        Air,        // Gateway::AirStatus of the node: its members in their order, as decimal numbers
        LastLines,  // the last lines of its log, as many as the argument says
        LinesFrom,  // its log from the line with that number on; the request waits for such a line
        Echo,       // empty, for the round trip; requested once, with another argument each time
        Foreign,    // its topics of foreign programs: ForeignTopicsIn reads them
        Agreement   // lines with tabs between: `members`, the lease in ms and the sorted members, then for
                    // each claim that it holds `claim`, fence, name; empty: it has no agreement
    };
    struct Answer
    {
        std::string Text;
        std::chrono::nanoseconds Took{0};  // from the beat with the last request to the answer
    };
    // Requests a report of a node, and drops another request for a report of that kind. The gateway repeats
    // the request, ever more seldom up to 2 s, until the answer comes.
    virtual void AskForReport(const std::string &node, Report what, std::uint32_t argument = 0) = 0;
    // Takes the answer to the last request, once it has come.
    virtual std::optional<Answer> TakeReport(const std::string &node, Report what) = 0;
    // Returns the topics in a report of the kind Foreign, which may be any text: lines that make no sense are
    // left out. Of the counters, the topics have the samples and the readers alone; the rest is 0. Texts in
    // them are printable ASCII.
    static std::vector<Gateway::ForeignTopic> ForeignTopicsIn(std::string_view report);

    // The readers of a message, of whatever origin node: the reading nodes, by name and each once, and the
    // number of other readers. Tools are no nodes. Types: the types in which they read it, each once.
    struct Subscribers
    {
        std::vector<std::string> Nodes;
        std::size_t Others = 0;
        std::vector<std::string> Types{};
    };
    // Has the gateway look up the readers of these messages, as far as discovery knows them by then.
    virtual void LookForSubscribers(const std::vector<std::string> &messages) = 0;
    // The result of the last look-up, by message; empty: the gateway has not looked yet.
    virtual std::optional<std::map<std::string, Subscribers>> FoundSubscribers() const = 0;

    // Subscribes as if the rule stood in the configuration. Its type must be in the MessageTypeRegistry
    // (std::invalid_argument if not). A message that is subscribed to already is then read from the nodes of
    // this rule, too, if it names the same type; for the rest its rule stays as it is.
    virtual void Subscribe(const SubscribeRule &rule) = 0;

    // Has messages for that queue expire after that time, whatever the configuration says; 0: never. `node`
    // is a name or a pattern. Holds for links that carried no message so far: all messages of a link live
    // equally long. Throws std::invalid_argument if the time is negative or longer than a year.
    virtual void SetExpiry(const std::string &node, const std::string &queue,
                           std::chrono::milliseconds expire) = 0;

    // Waits until the gateway has taken all that was posted before this call, but no longer than the limit.
    // Returns whether it has. A taken value, or a newer one in its place, is sent when a budget allows it.
    // Must not be called on the gateway's thread.
    virtual bool WaitUntilTaken(std::chrono::nanoseconds limit) = 0;

    // Sets a function that is called on the gateway's thread when any of the above has changed; it must be
    // quick.
    virtual void SetOnChange(std::function<void()> onChange) = 0;
};

}  // namespace Rabit
