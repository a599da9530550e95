#include "backfill/FileFetch.h"

#include <algorithm>

namespace Rabit::Backfill
{

void FileFetch::SetNode(std::uint64_t incarnation, bool isUp, Duration now)
{
    if (_incarnation != incarnation)
    {
        AskAgain(now);
    }
    if (isUp && !_isUp)
    {
        _patientUntil = now + Patience;
    }
    _incarnation = incarnation;
    _isUp = isUp;
}

void FileFetch::AskAgain(Duration at)
{
    _asked.clear();
    _notBefore = at;
}

std::vector<Question> FileFetch::Due(Duration now)
{
    std::vector<Question> due;
    if (!_isUp || now < _notBefore)
    {
        return due;
    }
    if (!_asked.empty() && now >= _patientUntil)
    {
        _asked.clear();
    }
    if (_asked.empty())
    {
        _askedUntil = _have;
        _patientUntil = now + Patience;
    }
    const auto ask = [this, &due](Kind kind, std::uint64_t from, std::uint64_t to)
    {
        Question question;
        question.kind = kind;
        question.number = _nextNumber++;
        question.name = _name;
        question.from = from;
        question.to = to;
        _asked.push_back({question.number, to});
        due.push_back(std::move(question));
    };
    if (!_facts)
    {
        if (_asked.empty())
        {
            ask(Kind::FACTS, 0, 0);
        }
        return due;
    }
    while (_asked.size() < MostAhead && _askedUntil < _facts->Size)
    {
        const std::uint64_t end = std::min(_askedUntil + PartSize, _facts->Size);
        ask(Kind::PART, _askedUntil, end);
        _askedUntil = end;
    }
    return due;
}

void FileFetch::Failed(std::uint64_t number, Duration now)
{
    if (std::any_of(_asked.begin(), _asked.end(),
                    [number](const Asked &asked) { return asked.Number == number; }))
    {
        AskAgain(now + Pause);
    }
}

std::span<const std::uint8_t> FileFetch::Answered(const Answer &answer, Duration now)
{
    if (answer.name != _name)
    {
        return {};
    }
    const auto asked = std::find_if(_asked.begin(), _asked.end(),
                                    [&answer](const Asked &one) { return one.Number == answer.number; });
    const bool isAsked = asked != _asked.end();
    if (isAsked)
    {
        _asked.erase(asked);
        _patientUntil = now + Patience;
    }
    if (isAsked && answer.kind == Kind::PART && answer.size <= answer.from &&
        (answer.result == Result::OK || answer.result == Result::FAILED))
    {
        // The file has become shorter, or cannot be opened now: the node is asked anew what it has.
        _facts.reset();
        AskAgain(now + Pause);
        return {};
    }
    if (isAsked && answer.result != Result::OK)
    {
        _refusal = answer.result == Result::NOT_ALLOWED
                       ? "it does not let this node fetch files (`fetch: from:` there)"
                   : answer.result == Result::UNKNOWN ? "it has no such file in its folder (`fetch: folder:`)"
                                                      : "it cannot read the file";
        AskAgain(now + Pause);
        return {};
    }
    if (isAsked && answer.kind == Kind::FACTS)
    {
        _facts = Facts{answer.size, answer.bytes};
        if (_have > answer.size)
        {
            StartOver();
        }
        return {};
    }
    if (answer.kind != Kind::PART || !_facts)
    {
        return {};
    }
    _refusal.clear();
    if (isAsked && answer.bytes.empty())
    {
        AskAgain(now + Pause);  // an answer has at least one byte
    }
    // The answer to a question of an earlier incarnation is as good: in the end the hash tells.
    if (answer.from != _have || answer.bytes.size() > _facts->Size - _have)
    {
        _repeated += answer.bytes.size();
        if (isAsked && answer.from > _have && !answer.bytes.empty())
        {
            AskAgain(now);  // answers come in order: the one before this is lost
        }
        return {};
    }
    _have += answer.bytes.size();
    return answer.bytes;
}

void FileFetch::StartOver()
{
    _have = 0;
    _asked.clear();
    _facts.reset();
}

}  // namespace Rabit::Backfill
