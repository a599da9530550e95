#include "backfill/Requester.h"

#include <algorithm>

#include "backfill/PostAnswers.h"
#include "backfill/PostsCodec.h"

namespace Rabit::Backfill
{
namespace
{

std::string TextOf(Result result)
{
    switch (result)
    {
        case Result::NOT_ALLOWED:
            return "it does not let this node have them (`backfill_to` there)";
        case Result::UNKNOWN:
            return "it does not record that message, or does not publish it";
        default:
            return "it cannot read its recording";
    }
}

}  // namespace

void Requester::SetNode(const std::string &name, std::uint64_t incarnation, bool isUp,
                        const std::vector<std::string> &messages, Duration now)
{
    Node &node = _nodes[name];
    const bool isOther = node.Incarnation != incarnation;
    const bool came = isUp && !node.IsUp;
    for (const std::string &message : messages)
    {
        node.Messages.try_emplace(message);
    }
    for (auto &[message, wanted] : node.Messages)
    {
        if (isOther)
        {
            wanted.Open.reset();
            wanted.NotBefore = now;
        }
        if (isOther || came)
        {
            wanted.NextSpans = now;
            wanted.NextLook = now;
            wanted.Look.Reset();
        }
        if (came && wanted.Open)
        {
            wanted.Open->At = now;
        }
    }
    node.Incarnation = incarnation;
    node.IsUp = isUp;
}

void Requester::StartOver(Duration now)
{
    for (auto &[name, node] : _nodes)
    {
        for (auto &[message, wanted] : node.Messages)
        {
            wanted = Wanted();
            wanted.NextSpans = now;
            wanted.NextLook = now;
            wanted.NotBefore = now;
        }
    }
}

const Requester::Asked *Requester::OpenQuestion(const Node &node)
{
    for (const auto &[message, wanted] : node.Messages)
    {
        if (wanted.Open)
        {
            return &*wanted.Open;
        }
    }
    return nullptr;
}

std::optional<Requester::Asked> Requester::Next(const std::string &node, std::uint64_t present,
                                                const std::string &message, const Wanted &wanted,
                                                Duration now) const
{
    if (wanted.Open || now < wanted.NotBefore)
    {
        return std::nullopt;
    }
    Asked asked;
    asked.At = now;
    asked.What.name = message;
    if (now >= wanted.NextSpans)
    {
        asked.What.kind = Kind::SPANS;
        asked.What.to = static_cast<std::uint64_t>(_last.count());
        return asked;
    }
    asked.What.kind = Kind::POSTS;
    asked.What.most = static_cast<std::uint32_t>(wanted.Most);
    if (wanted.Large)
    {
        asked.What.incarnation = wanted.Large->Incarnation;
        asked.What.from = wanted.Large->Covered.First;
        asked.What.to = asked.What.from + 1;
        asked.What.offset = wanted.Large->Bytes.size();
        return asked;
    }
    const auto gap = _ledger.NewestGap(node, message, present, now >= wanted.NextLook);
    if (!gap)
    {
        return std::nullopt;
    }
    asked.LooksAtNewest = gap->IsNewest;
    asked.What.incarnation = gap->Of.Incarnation;
    asked.What.from = gap->Stamps.First;
    asked.What.to = gap->Stamps.End;
    asked.What.had = PostsCodec::EncodeStamps(gap->Had, gap->Stamps.First);
    return asked;
}

// The messages of a node take turns.
std::optional<Requester::Asking> Requester::NextOf(const std::string &name, Node &node, Duration now)
{
    auto next = node.Messages.upper_bound(node.LastAsked);
    for (std::size_t i = 0; i < node.Messages.size(); ++i, ++next)
    {
        next = next == node.Messages.end() ? node.Messages.begin() : next;
        auto &[message, wanted] = *next;
        if (std::optional<Asked> asked = Next(name, node.Incarnation, message, wanted, now))
        {
            asked->What.number = _nextNumber++;
            node.LastAsked = message;
            wanted.Open = std::move(asked);
            return Asking{name, wanted.Open->What};
        }
    }
    return std::nullopt;
}

// So do the nodes.
std::vector<Requester::Asking> Requester::Due(Duration now)
{
    std::size_t open = 0;
    for (auto &[name, node] : _nodes)
    {
        for (auto &[message, wanted] : node.Messages)
        {
            if (node.IsUp && wanted.Open && now - wanted.Open->At >= Patience)
            {
                wanted.Open.reset();
                wanted.Most = std::max(wanted.Most / 2, PostAnswers::SmallestAnswer);
            }
        }
        const Asked *asked = OpenQuestion(node);
        open += node.IsUp && asked != nullptr && now - asked->At < Slow ? 1 : 0;
    }
    std::vector<Asking> due;
    auto next = _nodes.upper_bound(_lastAsked);
    for (std::size_t i = 0; i < _nodes.size() && open < MostAsked && now >= _restUntil; ++i, ++next)
    {
        next = next == _nodes.end() ? _nodes.begin() : next;
        auto &[name, node] = *next;
        if (!node.IsUp || OpenQuestion(node) != nullptr)
        {
            continue;
        }
        if (std::optional<Asking> asking = NextOf(name, node, now))
        {
            due.push_back(std::move(*asking));
            _lastAsked = name;
            ++open;
        }
    }
    return due;
}

void Requester::Failed(const std::string &name, const Question &question, Duration now)
{
    Wanted &wanted = _nodes[name].Messages[question.name];
    if (wanted.Open && wanted.Open->What == question)
    {
        wanted.Open.reset();
        wanted.NotBefore = now + Pause;
    }
}

std::optional<std::pair<Series, Range>> Requester::Answered(const std::string &name, Answer answer,
                                                            const Record &record, Duration now)
{
    const auto node = _nodes.find(name);
    const auto wanted = node == _nodes.end() ? decltype(node->second.Messages.end())()
                                             : node->second.Messages.find(answer.name);
    if (node == _nodes.end() || wanted == node->second.Messages.end() || !wanted->second.Open ||
        wanted->second.Open->What.kind != answer.kind || wanted->second.Open->What.number != answer.number ||
        wanted->second.Open->What.incarnation != answer.incarnation)
    {
        // The answer to a question that was asked again meanwhile is one of these.
        ++_malformed;
        return std::nullopt;
    }
    const Asked asked = std::move(*wanted->second.Open);
    wanted->second.Open.reset();
    wanted->second.Refusal = answer.result == Result::OK ? "" : TextOf(answer.result);
    wanted->second.IsLiveOnly = answer.result == Result::UNKNOWN;
    if (answer.result == Result::FAILED && answer.kind == Kind::POSTS &&
        answer.size == PostAnswers::NeverReadable && answer.from >= asked.What.from &&
        answer.from < answer.to && answer.to <= asked.What.to)
    {
        // Not whole, but there is nothing to ask for. Older posts are asked for next.
        _ledger.SetWhole({name, answer.name, answer.incarnation}, {answer.from, answer.to});
        wanted->second.Refusal.clear();
        wanted->second.Large.reset();
        wanted->second.Damaged = Series{name, answer.name, answer.incarnation};
        wanted->second.DamagedUntil = answer.to;
        wanted->second.DamagedAt = now;
        return std::nullopt;
    }
    if (answer.result != Result::OK)
    {
        if (answer.result != Result::FAILED)  // what failed may work later, and goes on where it was
        {
            wanted->second.Large.reset();
        }
        wanted->second.NotBefore = now + Pause;
        return std::nullopt;
    }
    if (answer.kind == Kind::SPANS)
    {
        // A node that has just begun has nothing yet.
        wanted->second.NextSpans = now + (answer.bytes.empty() ? ShortestLook : LongestLook);
        TakeSpans(name, answer, wanted->second, now);
        return std::nullopt;
    }
    if (now - asked.At < Patience / 4 && answer.bytes.size() >= wanted->second.Most / 2)
    {
        wanted->second.Most = std::min(wanted->second.Most * 2, PostAnswers::LargestAnswer);
    }
    return TakePosts(name, asked, answer, record, wanted->second, now);
}

void Requester::TakeSpans(const std::string &node, const Answer &answer, Wanted &wanted, Duration now)
{
    const auto spans = PostsCodec::DecodeSpans(answer.bytes);
    if (!spans)
    {
        ++_malformed;
        return;
    }
    bool isDamaged = false;  // as long as the damaged part is among what could be asked for
    for (const PostsCodec::Span &span : *spans)
    {
        _ledger.SetSpan({node, answer.name, span.Incarnation}, span.Stamps);
        isDamaged = isDamaged || (wanted.Damaged && wanted.Damaged->Incarnation == span.Incarnation &&
                                  span.Stamps.First < wanted.DamagedUntil);
    }
    if (!isDamaged && now - wanted.DamagedAt >= LossTold)
    {
        wanted.Damaged.reset();
    }
}

void Requester::RestAfter(std::size_t bytes, const Asked &asked, Duration now)
{
    const double share =
        std::min(1.0, static_cast<double>(bytes) / static_cast<double>(PostAnswers::LargestAnswer));
    _restUntil = now + std::chrono::duration_cast<Duration>(share * Rest * std::min(now - asked.At, Slow));
}

Requester::Part Requester::TakePart(const Asked &asked, Answer &answer, Wanted &wanted)
{
    if (answer.size == 0)
    {
        wanted.Large.reset();
        return Part::None;
    }
    const bool isFirst = !wanted.Large;
    const bool isOfThatPost =
        isFirst ? answer.from >= asked.What.from && answer.from < answer.to && answer.to <= asked.What.to
                : answer.size == wanted.Large->Size && answer.from == wanted.Large->Covered.First;
    if (!isOfThatPost || answer.offset != asked.What.offset || answer.size > LargestPost ||
        answer.bytes.empty() || answer.bytes.size() > answer.size - std::min(answer.size, answer.offset))
    {
        wanted.Large.reset();  // it is asked for from its beginning
        return Part::Malformed;
    }
    if (isFirst)
    {
        wanted.Large = LargePost{answer.incarnation, {answer.from, answer.to}, answer.size, {}};
    }
    LargePost &large = *wanted.Large;
    large.Bytes.insert(large.Bytes.end(), answer.bytes.begin(), answer.bytes.end());
    if (large.Bytes.size() < large.Size)
    {
        return Part::One;
    }
    answer.to = large.Covered.End;
    answer.bytes = std::move(large.Bytes);
    wanted.Large.reset();
    return Part::Last;
}

std::optional<std::pair<Series, Range>> Requester::TakePosts(const std::string &node, const Asked &asked,
                                                             Answer &answer, const Record &record,
                                                             Wanted &wanted, Duration now)
{
    RestAfter(answer.bytes.size(), asked, now);
    const Part part = TakePart(asked, answer, wanted);
    if (part == Part::One)
    {
        return std::nullopt;
    }
    const Range range{answer.from, answer.to};
    const auto posts = PostsCodec::DecodePosts(answer.bytes, answer.from);
    if (part == Part::Malformed || !posts || range.First < asked.What.from ||
        (part == Part::None && range.End > asked.What.to) ||
        std::any_of(posts->begin(), posts->end(),
                    [&range](const Post &post) { return !range.Contains(StampOf(post.SourceTime)); }))
    {
        ++_malformed;
        wanted.NotBefore = now + Pause;
        return std::nullopt;
    }
    if (asked.LooksAtNewest)
    {
        if (posts->empty())
        {
            wanted.Look.Next();
        }
        else
        {
            wanted.Look.Reset();
        }
        wanted.NextLook = now + wanted.Look.Interval();
    }
    const Series series{node, answer.name, answer.incarnation};
    bool areAllHere = true;
    for (const Post &post : *posts)
    {
        const Stamp stamp = StampOf(post.SourceTime);
        if (!_ledger.Take(series, stamp))
        {
            ++_repeated;
        }
        else if (const Taken taken = record(series, post); taken == Taken::NotNow)
        {
            _ledger.Undo(series, stamp);
            wanted.NotBefore = now + Pause;
            return std::nullopt;
        }
        else
        {
            _recorded += taken == Taken::Recorded ? 1 : 0;
            areAllHere = areAllHere && taken == Taken::Recorded;
        }
    }
    _ledger.SetWhole(series, range);
    // Nothing of the range is whole: the origin has not written it yet.
    if (range.IsEmpty())
    {
        wanted.NotBefore = now + std::chrono::seconds(1);
        return std::nullopt;
    }
    return areAllHere ? std::optional(std::pair(series, range)) : std::nullopt;
}

std::map<std::pair<std::string, std::string>, std::string> Requester::Refusals() const
{
    std::map<std::pair<std::string, std::string>, std::string> refusals;
    for (const auto &[name, node] : _nodes)
    {
        for (const auto &[message, wanted] : node.Messages)
        {
            if (node.IsUp && (!wanted.Refusal.empty() || wanted.Damaged))
            {
                refusals[{name, message}] = wanted.Refusal.empty()
                                                ? "a part of its recording is damaged, or was removed"
                                                : wanted.Refusal;
            }
        }
    }
    return refusals;
}

std::set<std::pair<std::string, std::string>> Requester::LiveOnly() const
{
    std::set<std::pair<std::string, std::string>> series;
    for (const auto &[name, node] : _nodes)
    {
        for (const auto &[message, wanted] : node.Messages)
        {
            if (wanted.IsLiveOnly)
            {
                series.emplace(name, message);
            }
        }
    }
    return series;
}

}  // namespace Rabit::Backfill
