#include "report/ProblemLog.h"

#include <rabit/base/Fnv1a.h>
#include <rabit/base/Printable.h>

#include <algorithm>
#include <iterator>
#include <utility>

namespace Rabit
{
namespace
{

constexpr std::size_t MostSubjectsInLine = 6;

bool IsDigit(char c)
{
    return c >= '0' && c <= '9';
}

// Replaces each number by one `#`, whatever its number of digits.
std::string WithoutNumbers(const std::string &text)
{
    std::string shape;
    for (std::size_t i = 0; i < text.size(); ++i)
    {
        if (!IsDigit(text[i]))
        {
            shape += text[i];
            continue;
        }
        shape += '#';
        while (i + 1 < text.size() &&
               (IsDigit(text[i + 1]) || (text[i + 1] == '.' && i + 2 < text.size() && IsDigit(text[i + 2]))))
        {
            ++i;
        }
    }
    return shape;
}

// Names in a reason may have come from the network.
std::string OneLine(std::string text)
{
    return Printable(std::move(text), ProblemLog::LongestLine);
}

std::string FirstWord(const std::string &text)
{
    return text.substr(0, text.find(' ') + 1);  // with the space; empty if there is none
}

// "subscribe Pose, Health, accept Commands": the first word is repeated only where it changes.
std::string Listed(const std::vector<std::string> &subjects)
{
    std::string text = subjects.front();
    for (std::size_t i = 1; i < subjects.size() && i < MostSubjectsInLine; ++i)
    {
        const std::string word = FirstWord(subjects[i]);
        text += ", " + (word == FirstWord(subjects[i - 1]) ? subjects[i].substr(word.size()) : subjects[i]);
    }
    if (subjects.size() > MostSubjectsInLine)
    {
        text += " and " + std::to_string(subjects.size() - MostSubjectsInLine) + " more";
    }
    return text;
}

}  // namespace

ProblemLog::ProblemLog(std::string list) : _list(std::move(list)) {}

void ProblemLog::Allowance::Refill(Duration now)
{
    if (_left >= _most)
    {
        return;
    }
    const auto more = (now - _refilled) / _pause;
    _left = static_cast<int>(std::min<std::int64_t>(_most, _left + more));
    _refilled += more * _pause;
}

bool ProblemLog::Allowance::Has(Duration now)
{
    Refill(now);
    return _left > 0;
}

bool ProblemLog::Allowance::IsFull(Duration now)
{
    Refill(now);
    return _left == _most;
}

void ProblemLog::Allowance::Take(Duration now)
{
    _refilled = _left == _most ? now : _refilled;
    --_left;
}

ProblemLog::Key ProblemLog::KeyOf(const Gateway::Problem &problem)
{
    return {problem.subject, problem.node, WithoutNumbers(problem.reason)};
}

void ProblemLog::AddTo(Groups &groups, const Key &key, Entry &entry)
{
    Group &group = groups[{std::get<1>(key), entry.Reason}];
    group.Subjects.push_back(std::get<0>(key));
    group.Members.push_back(&entry);
    group.Times = std::max(group.Times, entry.Times);
}

std::string ProblemLog::TextOf(const NodeAndReason &about, const Group &group)
{
    std::string text = Listed(group.Subjects);
    if (!about.first.empty() && text.find(about.first) == std::string::npos)
    {
        text += ", " + about.first;
    }
    return text + ": " + about.second;
}

bool ProblemLog::MakeRoom()
{
    if (_entries.size() < MostFollowed)
    {
        return true;
    }
    auto longestGone = _entries.end();
    for (auto entry = _entries.begin(); entry != _entries.end(); ++entry)
    {
        if (!entry->second.There &&
            (longestGone == _entries.end() || entry->second.Went < longestGone->second.Went))
        {
            longestGone = entry;
        }
    }
    if (longestGone == _entries.end())
    {
        return false;
    }
    _entries.erase(longestGone);
    return true;
}

std::vector<ProblemLog::Key> ProblemLog::TakeIn(const std::vector<Gateway::Problem> &present, Duration now)
{
    std::map<Key, bool> seen;
    std::vector<Key> order;
    for (const Gateway::Problem &problem : present)
    {
        const Key key = KeyOf(problem);
        if (!seen.emplace(key, true).second)
        {
            continue;
        }
        auto place = _entries.find(key);
        if (place == _entries.end() && !MakeRoom())
        {
            ++_notFollowed;
            continue;
        }
        const bool isNew = place == _entries.end();
        Entry &entry = isNew ? _entries[key] : place->second;
        if (isNew || (!entry.There && now - entry.Went >= Lasting))
        {
            entry.Came = now;
            entry.Times += entry.WasTold ? 1 : 0;
        }
        entry.There = true;
        entry.Reason = problem.reason;
        entry.Certain = problem.certain;
        order.push_back(key);
    }
    for (auto &[key, entry] : _entries)
    {
        if (entry.There && seen.count(key) == 0)
        {
            entry.There = false;
            entry.Went = now;
        }
    }
    return order;
}

bool ProblemLog::IsReplaced(const Key &key) const
{
    const auto &[subject, node, shape] = key;
    for (auto other = _entries.lower_bound({subject, node, ""}); other != _entries.end(); ++other)
    {
        if (std::get<0>(other->first) != subject || std::get<1>(other->first) != node)
        {
            return false;
        }
        if (other->second.There)
        {
            return true;
        }
    }
    return false;
}

ProblemLog::Groups ProblemLog::NewOnes(const std::vector<Key> &present, Duration now)
{
    Groups groups;
    for (const Key &key : present)
    {
        Entry &entry = _entries.at(key);
        const bool lasts = entry.Certain || now - entry.Came >= Lasting;
        if (!entry.Told && lasts && entry.Allowed.Has(now))
        {
            AddTo(groups, key, entry);
        }
    }
    return groups;
}

ProblemLog::Groups ProblemLog::GoneOnes(Duration now)
{
    Groups groups;
    for (auto &[key, entry] : _entries)
    {
        if (!entry.Told || entry.There || now - entry.Went < Lasting)
        {
            continue;
        }
        if (IsReplaced(key))
        {
            entry.Told = false;
            continue;
        }
        AddTo(groups, key, entry);
    }
    return groups;
}

void ProblemLog::Forget(Duration now)
{
    for (auto entry = _entries.begin(); entry != _entries.end();)
    {
        Entry &one = entry->second;
        const bool isOver = !one.There && !one.Told && now - one.Went >= Lasting && one.Allowed.IsFull(now);
        entry = isOver ? _entries.erase(entry) : std::next(entry);
    }
}

std::vector<std::string> ProblemLog::Look(const std::vector<Gateway::Problem> &present, Duration now)
{
    _notFollowed = 0;
    std::vector<std::string> lines;
    std::size_t waiting = 0;
    const std::vector<Key> order = TakeIn(present, now);
    for (const auto &[about, group] : GoneOnes(now))
    {
        if (!_lines.Has(now))
        {
            continue;  // stays told until its end can be told
        }
        _lines.Take(now);
        lines.push_back(OneLine("no longer: " + TextOf(about, group)));
        for (Entry *entry : group.Members)
        {
            entry->Told = false;
        }
    }
    for (const auto &[about, group] : NewOnes(order, now))
    {
        if (!_lines.Has(now))
        {
            waiting += group.Members.size();
            continue;
        }
        _lines.Take(now);
        const std::string times =
            group.Times > 1 ? " (" + std::to_string(group.Times) + " times since this was said last)" : "";
        lines.push_back(OneLine(TextOf(about, group) + times));
        for (Entry *entry : group.Members)
        {
            entry->Told = true;
            entry->WasTold = true;
            entry->Times = 0;
            entry->Allowed.Take(now);
        }
    }
    waiting += _notFollowed;
    if (waiting > 0 && !_saidThatSomeWait && _more.Has(now))
    {
        _more.Take(now);
        lines.push_back(std::to_string(waiting) + " more problems; " + _list + " lists all");
    }
    _saidThatSomeWait = waiting > 0;
    Forget(now);
    return lines;
}

ProblemLog::Standing ProblemLog::Lasted(Duration now) const
{
    Standing standing;
    std::string shapes;
    for (const auto &[key, entry] : _entries)
    {
        const bool lasts = entry.There ? entry.Certain || now - entry.Came >= Lasting
                                       : entry.Told && now - entry.Went < Lasting;
        if (!lasts)
        {
            continue;
        }
        Gateway::Problem &problem = standing.Problems.emplace_back();
        problem.subject = std::get<0>(key);
        problem.node = std::get<1>(key);
        problem.reason = entry.Reason;
        problem.certain = entry.Certain;
        shapes += problem.subject + '\n' + problem.node + '\n' + std::get<2>(key) + '\n';
    }
    standing.Digest = Fnv1a().Add(shapes).Folded();
    return standing;
}

std::vector<std::string> ProblemLog::AtEnd(const std::vector<Gateway::Problem> &present) const
{
    std::map<Key, Entry> untold;
    Groups groups;
    for (const Gateway::Problem &problem : present)
    {
        const Key key = KeyOf(problem);
        const auto known = _entries.find(key);
        const auto [place, isNew] = untold.emplace(key, Entry{});
        if (isNew && (known == _entries.end() || !known->second.Told))
        {
            place->second.Reason = problem.reason;
            AddTo(groups, key, place->second);
        }
    }
    std::vector<std::string> lines;
    for (const auto &[about, group] : groups)
    {
        if (lines.size() == LinesAtOnce)
        {
            break;
        }
        lines.push_back(OneLine(TextOf(about, group)));
    }
    return lines;
}

}  // namespace Rabit
