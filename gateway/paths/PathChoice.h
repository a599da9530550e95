#pragma once

#include <rabit/base/Backoff.h>
#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "presence/BeatCount.h"

namespace Rabit
{

// Chooses the path by which each other node is reached. Paths are numbered in the order of the configuration,
// the best first.
//
// - A node is reached by the first path on which it is UP, which has not failed lately, and by which the node
//   hears this one: each node says of others that it hears them by a later path alone.
// - A path fails for a node when the node stops being UP on it. After it is UP again it rests: other paths
//   are preferred for a second, and twice as long after each further failure, up to half a minute. A path
//   that has not failed for ten seconds since its rest counts as sound again. So a path that comes and goes
//   is left alone.
// - A path fails as well when many of the node's beats do not come by it, even if it goes for less time than
//   makes a node STALE: beats that were missed are counted, and a beat that came takes MissedForgiven of that
//   count. That holds only if another path misses half as many at most and has no smaller budget, since links
//   repair losses, and a slow path cannot carry what a fast one does. Beats that are missed during a rest are
//   no further failure.
// - A path rests for ShortRest at most if no other path on which the node is UP when it fails has as large a
//   budget: a slow path does not stand in for a fast one for half a minute.
// - If the node is UP on no path, the choice stays as it was.
// - While the chosen path is in doubt, a second one is used as well (Second), since nobody knows yet which of
//   them works. It is in doubt while queue messages are unanswered for longer than usual, or the node itself
//   sends by another path, and for the time Both after that: by then its beats tell. It is in doubt while the
//   node's beat is late there: it did not come, or was held up on the way. And it is in doubt from a failure
//   until it counts as sound again, if another path is sound. The node is UP on the second path.
// - While messages of the node come by another path than the chosen one, answers go by that path as well: the
//   node may lack those that went by the chosen one. Answers to answers do not, so this ends with the doubt.
//
// A pure state machine; `now` never goes back. All calls are some comparisons if there is one path. The
// gateway's thread only.
class PathChoice
{
public:
    using Duration = std::chrono::nanoseconds;

    // How long a second path is used as well after the last sign of a doubt.
    static constexpr Duration Both = std::chrono::seconds(2);
    // Frames that come by another path are a sign if none has come by the chosen one for this long.
    static constexpr Duration Silence = std::chrono::milliseconds(100);
    // How long answers go by the path by which a message came.
    static constexpr Duration AnswersToo = std::chrono::milliseconds(500);
    static constexpr Backoff::Settings Rest{.First = std::chrono::seconds(1),
                                            .Longest = std::chrono::seconds(30)};
    static constexpr Duration Sound = std::chrono::seconds(10);
    // Longer than a path takes that is gone for 2 s and there for 2 s, so that one is left alone.
    static constexpr Duration ShortRest = std::chrono::seconds(4);
    // One loss in ten makes a path fail about once in some minutes, one in five twice a minute.
    static constexpr double MostMissed = 4.0;
    static constexpr double MissedForgiven = 0.25;

    // `budgets`: bytes a second that each path may carry; a path without a number has no limit.
    explicit PathChoice(std::size_t paths, std::vector<double> budgets = {});

    std::size_t Paths() const { return _paths; }
    // The state of the node on a path, as its beats there tell, and whether they say that it hears this node
    // by that path and by no better one.
    void Heard(const std::string &node, std::size_t path, Gateway::NodeState state, bool hearsHereFirst,
               Duration now);
    // Counts the node's beats that came by that path, and that did not; `beats` counts all of its
    // incarnation. To be called when beats did not come, for the other paths first, and before Heard tells
    // what the beat after them says.
    void Missed(const std::string &node, std::size_t path, const BeatCount &beats, Duration now);
    // Whether the node's newest beat by that path is older than beats usually become, or was held up on the
    // way.
    void Late(const std::string &node, std::size_t path, bool isLate);
    // A queue message for the node remains unanswered for longer than usual. Returns true if this is a new
    // doubt and there is a second path.
    bool Unanswered(const std::string &node, Duration now);
    // A new frame of the links came from the node by that path before it came by another.
    void CameBy(const std::string &node, std::size_t path, Duration now);
    // A frame with messages of the node came by that path, whether it came by others before or not.
    void MessageCameBy(const std::string &node, std::size_t path, Duration now);
    // The node is known on no path any more.
    void Forget(const std::string &node) { _nodes.erase(node); }
    // Lets time pass. Returns the nodes whose path has changed since the last call.
    std::vector<std::string> TakeChanged(Duration now);
    // When to call TakeChanged at the latest; empty: not before the next input.
    std::optional<Duration> Due() const { return _due; }

    // The path of that node; the first one if the node is not known.
    std::size_t Of(std::string_view node) const;
    // A path that is used for that node as well. `isAnswer`: for link frames without messages.
    std::optional<std::size_t> Second(std::string_view node, Duration now, bool isAnswer = false) const;
    // The nodes that are heard well on that path and on no better one, though there are better ones.
    std::vector<std::string> FirstHeardOn(std::size_t path) const;
    // True if FirstHeardOn has changed since the last call.
    bool TakeFirstHeardChanged() { return std::exchange(_firstHeardChanged, false); }
    // True if any node that is not LOST is reached by that path. The first path counts while nobody is known.
    bool CarriesAny(std::size_t path) const;
    // True if that path is the second one of any node.
    bool IsSecondOfAny(std::size_t path, Duration now) const;

private:
    struct Way
    {
        Gateway::NodeState State = Gateway::NodeState::LOST;
        bool HearsHereFirst = false;
        bool IsLate = false;
        Backoff Rest{PathChoice::Rest};
        Duration RestFor{0};  // after the last failure
        std::optional<Duration> RestsUntil;
        BeatCount Beats;             // when they were counted last
        double Missed = 0.0;         // lately
        Duration CameAt = -Silence;  // the last frame of the links that came by it first

        bool Rests(Duration now) const { return RestsUntil && *RestsUntil > now; }
        bool IsSound(Duration now) const { return !RestsUntil || now - *RestsUntil > Sound; }
        bool IsSteady(Duration now) const
        {
            return State == Gateway::NodeState::UP && !IsLate && IsSound(now);
        }
    };
    struct Node
    {
        std::vector<Way> Ways;
        std::size_t Choice = 0;
        std::size_t FirstHeardOn = 0;  // the first path that is UP and does not rest; else that is UP
        std::optional<std::size_t> Second;
        Duration SecondUntil{0};
        std::optional<std::size_t> AnswersBy;
        Duration AnswersUntil{0};
    };

    Node &NodeOf(const std::string &node);
    void Fail(Node &node, std::size_t path, Duration now) const;
    // The first other path than the chosen one on which the node is UP, a steady one before the others.
    std::optional<std::size_t> Other(const Node &node, Duration now) const;
    // True if there is a path that misses clearly fewer beats than that one, which misses many, and that may
    // carry as much.
    bool IsAnyBetter(const Node &node, std::size_t path, Duration now) const;
    void ChooseHeard(Node &node, Duration now);
    void Choose(const std::string &name, Node &node, Duration now);

    const std::size_t _paths;
    std::vector<double> _budgets;  // of each path
    std::map<std::string, Node, std::less<>> _nodes;
    std::vector<std::string> _changed;
    std::optional<Duration> _due;
    bool _firstHeardChanged = false;
};

}  // namespace Rabit
