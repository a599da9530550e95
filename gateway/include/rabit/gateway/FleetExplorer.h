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
#include <vector>

namespace Rabit
{

// For programs that look at a fleet whose messages they were not built with: what each node offers, the types
// of that as IDL text, and subscriptions made while the gateway runs. GatewayManager::Explorer gives it; it
// lives as long as the gateway. All functions may be called from any thread; the gateway acts on them a
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
        std::string Other;      // node; empty: one that this gateway has not heard
        unsigned Percent = 0;   // Filling: how full
        unsigned Messages = 0;  // Filling: refused in the last half minute; InDoubt: in it
    };

    struct Node
    {
        std::string Name;
        Gateway::NodeState State = Gateway::NodeState::LOST;
        std::uint64_t Incarnation = 0;
        // Empty: its announcement has not come. Names in it are valid ones, but for the types', which may be
        // any text.
        std::optional<Gateway::Announcement> Offers;
        bool IsTwice = false;  // another live node has the same name
        // How far its wall clock is ahead of this node's, in seconds; half a round trip more or less. NaN:
        // not known.
        double ClockAhead = std::numeric_limits<double>::quiet_NaN();
        // Beats of its present life since it was first heard: that came, and that did not.
        std::uint64_t BeatsHeard = 0;
        std::uint64_t BeatsMissed = 0;
        // What keeps queue messages between it and others from getting on, as it says itself; the worst come
        // first, and no more than four are told.
        std::vector<Strain> Strains;
    };
    // The other nodes, by name.
    virtual std::vector<Node> Nodes() const = 0;

    // Asks that node for the text of a type, by the definition hash that its announcement gives. It goes on
    // asking, ever more seldom, until the text comes or another node is to be asked for it.
    virtual void AskForType(const std::string &node, const std::string &type, std::uint64_t definition) = 0;
    // The text of that hash, once it has come.
    virtual std::optional<std::string> TypeText(std::uint64_t definition) const = 0;

    // Who reads a message, whichever node's: nodes, by name and each once, and of what else there is how
    // much. Tools are no nodes.
    struct Subscribers
    {
        std::vector<std::string> Nodes;
        std::size_t Others = 0;
    };
    // Has the gateway look who reads these messages, as far as discovery has told by then.
    virtual void LookForSubscribers(const std::vector<std::string> &messages) = 0;
    // What it found, by message, when it looked last; empty: it has not looked yet.
    virtual std::optional<std::map<std::string, Subscribers>> FoundSubscribers() const = 0;

    // As if the rule stood in the configuration. Its type must be in the MessageTypeRegistry
    // (std::invalid_argument if not). A message that is subscribed to already stays as it is.
    virtual void Subscribe(const SubscribeRule &rule) = 0;

    // Waits until the gateway has taken all that was posted before this call, but no longer than the limit.
    // Returns whether it has. A value that is taken goes out when a budget allows it, or a newer one does in its
    // place. Not on the gateway's thread.
    virtual bool WaitUntilTaken(std::chrono::nanoseconds limit) = 0;

    // Called on the gateway's thread when something of the above has changed; must be quick.
    virtual void SetOnChange(std::function<void()> onChange) = 0;
};

}  // namespace Rabit
