#pragma once

#include <rabit/RabitEvent.h>
#include <rabit/gateway/GatewayConfig.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace Rabit
{

// Claims of which one node has each at any time: a cell to fly, a target to look at, the lead.
//
// The promise: at any time a claim has at most one holder among the members of `agreement` in the
// configuration. Each holder has a higher fence, a number, than each holder before it. Without a majority of
// the members in reach there is no new holder, and a holder without one loses its claims within the lease.
//
//     Coverage(Rabit::GatewayConfig &config) : RabitManager("Coverage"), _claims(config)
//     {
//         _claims.ConnectChanged(WakeUpHandler());
//     }
//     ...
//     _claims.Claim("cell 17");               // asks until Release
//     if (_claims.StillMine("cell 17")) ...   // look again before each effect
//
// The promise holds under these conditions:
// - Clocks: those of members are wrong by 1 % at most, and none stands still unnoticed. They run on while the
//   computer is suspended. A standstill that shows in the beats of the others ends all claims of the node. A
//   virtual machine that was paused and has not noticed is outside of the promise.
// - Restarts: a node that starts does not vote for the time of a lease, and holds nothing. The claims of its
//   former life are free after that time, too. With `state_dir` fences rise over all restarts; without it
//   they rise as long as wall clocks do.
// - Partitions: the side with a majority goes on. Of two equal halves neither has one, so an odd number of
//   members is best.
// - Lists: all members need the same `members` and `lease`, since two lists may have majorities without a
//   common member. Differing ones are a problem in Gateway/Fleet on both sides, and do not vote for each
//   other. A list changes with all nodes down.
//
// StillMine is a look, not a guard: a program that is suspended after it acts too late. Only a receiver that
// refuses lower fences is a guard. Flying to a cell, which nobody checks, is exclusive but for one suspended
// unit of work.
//
// After the lease of Gray and Cheriton (1989), the fences (sequencers) of Chubby (Burrows 2006), and a
// majority without a log as in PaxosLease (Trencseni, Gazso and Reinhardt 2012).
//
// Threads: all functions may be called from any thread, and none waits for the network or a disk. All objects
// of one configuration and its copies have the same claims; the gateway of that configuration serves them,
// and a claim that is asked for earlier waits for it. If the gateway ends, all claims are lost. The next
// gateway of that configuration asks again for those of Claim, but not for those of Try.
class Claims
{
public:
    // Claims of one node at a time, and bytes of a name, which is any text.
    static constexpr std::size_t Most = 64;
    static constexpr std::size_t LongestName = 64;
    // The claim of the functions for a leader, a claim like any other.
    static constexpr const char *Leadership = "leader";

    struct Status
    {
        bool IsWanted = false;  // it is held, or asked for
        // Set: this node holds it, under this fence. A claim that was lost and won again has another one.
        std::optional<std::uint64_t> Fence{};
        std::string Holder{};  // the node that holds it, as far as this one has heard; empty: not known
        // Why it is not held, in words, as far as there was an answer: another node has it, no majority
        // answers, the lease has ended, or no gateway runs.
        std::string Reason{};
    };

    // Before the gateway is made, for instance in NodeProgram::AddManagers: adds itself to the configuration.
    // Throws ConfigError if that has no `agreement`.
    explicit Claims(GatewayConfig &config);

    // Asks for a claim until Release, whatever becomes of it. Returns false if the name is empty or too long,
    // or if too many are wanted, or were until a moment ago: the others take a released claim back first.
    bool Claim(const std::string &claim);
    // Asks once: after a refusal or a loss, the claim is not wanted any more. Else as Claim.
    bool Try(const std::string &claim);
    // From now on the claim is not held, nor asked for. Others get it a moment later, or, if this node is cut
    // off, after the lease.
    void Release(const std::string &claim);

    // True if this node holds the claim now. Costs a microsecond or so.
    bool StillMine(std::string_view claim) const { return FenceOf(claim).has_value(); }
    // The fence under which this node holds it; empty: it does not.
    std::optional<std::uint64_t> FenceOf(std::string_view claim) const;
    // The claims that this node holds, by name.
    std::vector<std::string> Mine() const;
    Status StatusOf(std::string_view claim) const;

    // Asks for the lead until Release(Leadership).
    bool BeLeader() { return Claim(Leadership); }
    bool IsLeader() const { return StillMine(Leadership); }
    // The node that has the lead, as far as this one has heard: not to be acted on as on IsLeader. Empty:
    // none is known.
    std::string Leader() const { return StatusOf(Leadership).Holder; }

    // Calls the handler after a claim of this node was won, lost or refused. A RabitQuickHandler, as that of
    // RabitManager::WakeUpHandler, is called on the gateway's thread, others on its thread for handlers.
    RabitConnection ConnectChanged(RabitHandler handler);

private:
    std::shared_ptr<AgreementHub> _hub;
};

}  // namespace Rabit
