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

// Decides which problems are worth a line in the log, so that each is said once and nothing floods. Pure: it
// is fed with the problems that are there now and the time, and gives the lines. Not thread-safe. Bounded.
//
// - A problem is told once it has lasted, counted from when it was first there, or at once if it is certain;
//   and once more when it has been gone for as long. One that comes and goes faster than that counts as there
//   all the time.
// - Texts that differ only in numbers are one problem. If another reason takes the place of one with the same
//   subject and node, the new one is told, and not that the former is gone.
// - Problems that begin together, with one reason and one node, share a line.
// - One that keeps coming back is told a few times, then once a minute, with how often it came. All together
//   have a limit as well; what is beyond waits for its turn, and one line says that.
class ProblemLog
{
public:
    using Duration = std::chrono::nanoseconds;

    static constexpr Duration Lasting = std::chrono::seconds(2);
    // One problem: so often at any rate, and once more after each pause.
    static constexpr int TimesAtOnce = 3;
    static constexpr Duration Pause = std::chrono::minutes(1);
    // All problems: so many lines at any rate, and one more after each pause.
    static constexpr int LinesAtOnce = 40;
    static constexpr Duration LinePause = std::chrono::seconds(10);
    // What is beyond is not followed; one line says that.
    static constexpr std::size_t MostFollowed = 1000;
    static constexpr std::size_t LongestLine = 600;

    // `list` names where all problems stand, for the line that says that there are more.
    explicit ProblemLog(std::string list);

    // The problems that are there now; time never goes back. Returns lines of printable ASCII.
    std::vector<std::string> Look(const std::vector<Gateway::Problem> &present, Duration now);

    // The last word: lines for those of the problems that are there and were not told, however short they
    // have been there.
    std::vector<std::string> AtEnd(const std::vector<Gateway::Problem> &present) const;

private:
    // Subject, node and the reason without its numbers.
    using Key = std::tuple<std::string, std::string, std::string>;

    // So many times at once, and one more after each pause.
    class Allowance
    {
    public:
        Allowance(int most, Duration pause) : _most(most), _pause(pause), _left(most) {}
        bool Has(Duration now);
        // Only if it has.
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

    // Problems that are said together, by node and reason.
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

    // In the order of the problems, each once.
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
