#pragma once

#include <rabit/gateway/Fleet.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
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
// One number decides: the debt of a path for a node, in beats. It is the part of a beat by which the next one
// is overdue, and the beats that did not come lately; each beat that came takes Forgiven of these. So the
// debt rises while a path is silent or slow, and a path that comes and goes stays in debt.
//
// - A node is reached by the first path on which it is UP and whose debt is small enough. It may be above the
//   smallest debt by Leave, or by Return if another path is in use. A path with a larger budget may owe Slow
//   more, since links repair losses, and a slow path cannot carry what a fast one does.
// - A node says of others that it hears them by a later path alone. It is reached by no earlier one then.
// - A path in doubt is not used alone (Second). It is in doubt while it owes more than another path by Doubt.
//   It is also in doubt while queue messages are unanswered for longer than usual, or the node's frames come
//   by another path alone. It stays so for the time Both after that: by then its beats tell.
// - Answers go by the path by which messages of the node came as well: the node may lack those that went by
//   the chosen one. Answers to answers do not, so this ends with the doubt.
// - A node that starts again owes nothing: its silence was not the path's. If a node is UP on no path, the
//   choice stays as it was.
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
    // In beats. A path that loses one beat in three keeps its debt; 14 beats end the largest one.
    static constexpr double Forgiven = 0.5;
    static constexpr double Most = 8.0;
    static constexpr double Leave = 4.0;
    static constexpr double Return = 1.0;
    static constexpr double Slow = 4.0;
    static constexpr double Doubt = 0.25;

    // `budgets`: bytes a second that each path may carry; a path without a number has no limit.
    explicit PathChoice(std::size_t paths, std::vector<double> budgets = {});

    std::size_t Paths() const { return _paths; }
    // The state of the node on a path, as its beats there tell. `hearsHereFirst`: the beats say that it hears
    // this node by that path and by no better one.
    void Heard(const std::string &node, std::size_t path, Gateway::NodeState state, bool hearsHereFirst);
    // The beats of a node by one path.
    struct Beats
    {
        // A higher one is a later life while the node is UP on any path.
        std::uint64_t Incarnation = 0;
        BeatCount Count;      // all of this incarnation
        Duration Overdue{0};  // the next one is, or the newest one was when it came
        Duration Period{1};   // from one to the next
    };
    // To be called some times in a period, for each path by which the node is heard.
    void Look(const std::string &node, std::size_t path, const Beats &beats);
    // A queue message for the node remains unanswered for longer than usual. Returns true if this is a new
    // doubt and there is a second path.
    bool Unanswered(const std::string &node, Duration now);
    // A new frame of the links came from the node by that path before it came by another.
    void CameBy(const std::string &node, std::size_t path, Duration now);
    // A frame with messages of the node came by that path, whether it came by others before or not.
    void MessageCameBy(const std::string &node, std::size_t path, Duration now);
    // The node is known on no path any more.
    void Forget(const std::string &node) { _nodes.erase(node); }
    // Chooses anew after the calls above. Returns the nodes whose path has changed.
    std::vector<std::string> TakeChanged();

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
        BeatCount Count;             // as it was looked at last
        double Missed = 0.0;         // beats that did not come, less those forgiven
        double Overdue = 0.0;        // beats
        Duration CameAt = -Silence;  // the last frame of the links that came by it first

        bool IsUp() const { return State == Gateway::NodeState::UP; }
        double Debt() const { return Missed + Overdue; }
    };
    struct Node
    {
        std::vector<Way> Ways;
        std::uint64_t Incarnation = 0;
        std::size_t Choice = 0;
        std::size_t FirstHeardOn = 0;
        Duration DoubtUntil{0};
        std::size_t AnswersBy = 0;
        Duration AnswersUntil{0};
    };

    // The path with the smallest debt of those on which the node is UP, without that one.
    static std::optional<std::size_t> Other(const Node &node, std::size_t than);
    // The first of the paths from `from` on that may be used, while `present` is in use; empty: UP on none.
    std::optional<std::size_t> Best(const Node &node, std::size_t from, std::size_t present) const;

    const std::size_t _paths;
    std::vector<double> _budgets;  // of each path
    std::map<std::string, Node, std::less<>> _nodes;
    bool _isNew = false;  // since the last choice
    bool _firstHeardChanged = false;
};

}  // namespace Rabit
