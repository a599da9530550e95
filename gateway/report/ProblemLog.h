#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "gateway.idl.h"

namespace Rabit
{

// Decides which problems get a line in the log, so that each is told once and none floods it. Pure: takes
// the present problems and the time, and returns the lines. Not thread-safe. Bounded.
//
// - A problem is told when it has lasted for `Lasting`, or at once if it is certain. Its end is told when
//   it has been gone for `Lasting`. A problem that comes and goes faster counts as present all the time.
// - Texts that differ only in numbers are one problem. If another reason of the same subject and node
//   replaces a problem, the new one is told, and the end of the former is not.
// - Problems that begin together, with one reason and one node, share a line.
// - A problem that keeps coming back is told a few times, then once a minute, with how often it came. All
//   problems together have a limit, too: those beyond it wait for their turn, and one line says so.
class ProblemLog
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Lasting = std::chrono::seconds(2);
    // One problem is told up to three times at once, and once more after each `Pause`.
    static constexpr int TimesAtOnce = 3;
    static constexpr Duration Pause = std::chrono::minutes(1);
    // All problems together get up to 40 lines at once, and one more after each `LinePause`.
    static constexpr int LinesAtOnce = 40;
    static constexpr Duration LinePause = std::chrono::seconds(10);
    // Problems beyond this number are not followed; one line says so.
    static constexpr std::size_t MostFollowed = 1000;
    static constexpr std::size_t LongestLine = 600;

    // `list` names the place of all problems, for the line that says that there are more.
    explicit ProblemLog(std::string list);

    // Takes the problems that are present now, and returns lines of printable ASCII. `now` never goes back.
    std::vector<std::string> Look(const std::vector<Gateway::Problem> &present, Duration now);

    // The problems that have lasted, as of the last look. A problem that comes and goes faster than `Lasting`
    // counts as present all the time.
    struct Standing
    {
        std::vector<Gateway::Problem> Problems;
        std::uint32_t Digest = 0;  // of the problems, without the numbers in their reasons
    };
    Standing Lasted(Duration now) const;

    // For the end: returns lines for the present problems that were not told, even if they have not lasted.
    std::vector<std::string> AtEnd(const std::vector<Gateway::Problem> &present) const;

private:
    // Subject, node and the reason without its numbers.
    using Key = std::tuple<std::string, std::string, std::string>;

    // A token bucket: `most` at once, and one more after each pause.
    class Allowance
    {
    public:
        Allowance(int most, Duration pause) : _most(most), _pause(pause), _left(most) {}
        bool Has(Duration now);
        // Takes one; only if `Has`.
        void Take(Duration now);
        bool IsFull(Duration now);

    private:
        void Refill(Duration now);

        int _most;
        Duration _pause;
        int _left;
        Duration _refilled{0};
    };

    struct Entry
    {
        std::string Reason;  // the latest text
        bool Certain = false;
        bool There = false;       // at the last look
        Duration Came{0};         // there since then, without a long gap
        Duration Went{0};         // if it is not there: since when
        bool Told = false;        // said that it is there, and not yet that it is gone
        bool WasTold = false;     // ever
        std::uint64_t Times = 0;  // how often it came since it was told
        Allowance Allowed{TimesAtOnce, Pause};
    };

    // Problems that share a line: of one node, with one reason.
    struct Group
    {
        std::vector<std::string> Subjects;
        std::uint64_t Times = 0;
        std::vector<Entry *> Members;
    };

    using NodeAndReason = std::pair<std::string, std::string>;
    using Groups = std::map<NodeAndReason, Group>;

    static Key KeyOf(const Gateway::Problem &problem);
    static void AddTo(Groups &groups, const Key &key, Entry &entry);
    static std::string TextOf(const NodeAndReason &about, const Group &group);

    // Returns the keys of the present problems, each once, in their order.
    std::vector<Key> TakeIn(const std::vector<Gateway::Problem> &present, Duration now);
    bool MakeRoom();
    bool IsReplaced(const Key &key) const;
    Groups NewOnes(const std::vector<Key> &present, Duration now);
    Groups GoneOnes(Duration now);
    void Forget(Duration now);

    const std::string _list;
    std::map<Key, Entry> _entries;
    std::size_t _notFollowed = 0;  // at the last look
    Allowance _lines{LinesAtOnce, LinePause};
    Allowance _more{1, Pause};
    bool _saidThatSomeWait = false;
};

}  // namespace Rabit
