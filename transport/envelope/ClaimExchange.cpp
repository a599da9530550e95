#include "envelope/ClaimExchange.h"

#include <rabit/base/Earliest.h>

#include <algorithm>

namespace Rabit::Envelope
{

void ClaimExchange::Heard(SessionTag session, Standing standing, Epoch in, TimePoint now)
{
    if (_refused.Find(session) != nullptr)
    {
        return;
    }
    const std::size_t index = standing == Standing::Proven ? 0 : 1;
    Series &series = _series[index];
    _series[1 - index].Questions.erase(session);
    auto found = series.Questions.find(session);
    const bool isNew = found == series.Questions.end();
    const bool wasIdle = (isNew || !IsActive(series, found->second)) && !DueOf(series);
    if (isNew)
    {
        Forget(series, now);
        if (series.Questions.size() >= MostAsked)
        {
            series.Questions.erase(series.Questions.begin());
        }
        found = series.Questions.emplace(session, Question{}).first;
        // A question that has just gone to all went to this session, too.
        found->second.AskedAt = _askedIn.first == in ? _askedIn.second : TimePoint{};
    }
    Question &question = found->second;
    question.In = in;
    question.Of = standing;
    question.Heard = now;
    question.Left = MostUnverified;
    const bool isQuiet = now - series.Heard >= Forgotten;
    series.Heard = now;
    const TimePoint soon = std::max(now + Gather, question.AskedAt + FirstRetry);
    if (!series.Retry.Due() || isQuiet)
    {
        series.Retry.Begin(soon);
    }
    // Anybody can invent unknown sessions, so these hasten nothing. Nor do claims once many were in vain:
    // they may be recorded.
    else if (isNew && standing != Standing::Unknown && series.Retry.Interval() <= QuickRetry)
    {
        series.Retry.Hasten(soon);
    }
    else if (wasIdle)
    {
        series.Retry.Postpone(soon);
    }
}

bool ClaimExchange::IsActive(const Series &series, const Question &question)
{
    return series.Retry.Due() && question.Heard + Patience >= *series.Retry.Due() && question.Left > 0;
}

void ClaimExchange::Forget(Series &series, TimePoint now)
{
    std::erase_if(series.Questions, [now](const auto &each) { return now - each.second.Heard > Forgotten; });
    if (series.Questions.empty())
    {
        series.Retry.Stop();
    }
}

void ClaimExchange::Asked(SessionTag session, Standing standing, const Nonce &nonce, Epoch in, TimePoint now)
{
    const Answered *const answered = _answered.Find(session);
    if (nonce == Nonce{} ||
        (answered != nullptr && answered->Of == nonce && now - answered->At < answered->Gap.Interval()))
    {
        return;
    }
    if (!_pending.contains(session) && _pending.size() >= Claim::MostAnswers)
    {
        // The newest ones are kept, but for better ones.
        const auto least = std::min_element(
            _pending.begin(), _pending.end(),
            [](const auto &a, const auto &b)
            { return std::pair(a.second.By, a.second.Due) < std::pair(b.second.By, b.second.Due); });
        if (least->second.By > standing)
        {
            return;
        }
        _pending.erase(least);
    }
    const auto [at, isNew] = _pending.try_emplace(session);
    at->second = {.Of = nonce, .In = in, .By = standing, .Due = isNew ? now + Gather : at->second.Due};
}

void ClaimExchange::Proven(SessionTag session, TimePoint now)
{
    _initial.Stop();
    _unprovenGap.Reset();
    for (Series &series : _series)
    {
        if (series.Questions.erase(session) == 0)
        {
            continue;
        }
        if (series.Questions.empty())
        {
            series.Retry.Stop();
        }
        else
        {
            series.Retry.Begin(std::max(now + Gather, _askedIn.second + FirstRetry));
        }
    }
}

void ClaimExchange::Refuse(SessionTag session)
{
    _refused.Put(session, true);
    for (Series &series : _series)
    {
        series.Questions.erase(session);
    }
}

void ClaimExchange::WantCertificate(Epoch in, TimePoint now)
{
    if (!_certificate)
    {
        _certificate.emplace(in, std::max(now + Gather, _certificateNotBefore));
    }
}

std::optional<TimePoint> ClaimExchange::DueOf(const Series &series)
{
    const bool isAny = std::any_of(series.Questions.begin(), series.Questions.end(),
                                   [&series](const auto &each) { return IsActive(series, each.second); });
    return isAny ? series.Retry.Due() : std::nullopt;
}

TimePoint ClaimExchange::DueOf(const Pending &answer) const
{
    return answer.By == Standing::Proven ? answer.Due : std::max(answer.Due, _unprovenNotBefore);
}

std::optional<TimePoint> ClaimExchange::Due() const
{
    auto due = Earliest({_initial.Due(), DueOf(_series[0]), DueOf(_series[1])});
    if (_certificate)
    {
        due = Earliest<TimePoint>({due, _certificate->second});
    }
    for (const auto &[session, answer] : _pending)
    {
        due = Earliest<TimePoint>({due, DueOf(answer)});
    }
    for (const Series &series : _series)
    {
        for (const auto &[session, question] : series.Questions)
        {
            due = question.IsWaiting ? Earliest<TimePoint>({due, question.Heard}) : due;
        }
    }
    return due;
}

// Until when the answers to the last question may come. Long ago if there are questions in another epoch.
TimePoint ClaimExchange::AnsweredBy(const Series &series) const
{
    std::chrono::milliseconds answers{0};
    for (const auto &[session, question] : series.Questions)
    {
        if (question.In != _askedIn.first)
        {
            return TimePoint{};
        }
        answers += IsActive(series, question) ? AnswerTakes : std::chrono::milliseconds(0);
    }
    return _askedIn.second + std::min(answers, LongestAnswers);
}

// Makes the questions wait that are due. A claim asks in one epoch, so several claims may follow. Until they
// have gone, the time for an answer does not begin.
void ClaimExchange::Fire(Series &series, TimePoint now)
{
    const bool isWaiting = std::any_of(series.Questions.begin(), series.Questions.end(),
                                       [](const auto &each) { return each.second.IsWaiting; });
    if (isWaiting || !IsBy(DueOf(series), now))
    {
        return;
    }
    if (const TimePoint answered = AnsweredBy(series); answered > now)
    {
        series.Retry.Postpone(answered);
        return;
    }
    for (auto &[session, question] : series.Questions)
    {
        question.IsWaiting =
            question.IsWaiting || (IsActive(series, question) && now - question.AskedAt >= FirstRetry);
    }
    series.Retry.Done(now);
    Forget(series, now);
}

std::optional<Epoch> ClaimExchange::NextEpoch(Epoch newest, TimePoint now) const
{
    for (const auto &[session, answer] : _pending)
    {
        if (DueOf(answer) <= now)
        {
            return answer.In;
        }
    }
    for (const Series &series : _series)
    {
        for (const auto &[session, question] : series.Questions)
        {
            if (question.IsWaiting)
            {
                return question.In;
            }
        }
    }
    if (_certificate && _certificate->second <= now)
    {
        return _certificate->first;
    }
    return _initial.IsDue(now) ? std::optional(newest) : std::nullopt;
}

// True if a claim in that epoch asks the session. Each claim asks all that have to be asked in its epoch and
// were not just now. `isAsking`: the claim asks another session already.
bool ClaimExchange::IsAsked(const Question &question, Epoch in, bool isAsking, TimePoint now)
{
    return question.In == in && question.Left > 0 &&
           (question.IsWaiting || isAsking ||
            (now - question.Heard <= Patience && now - question.AskedAt >= FirstRetry));
}

std::optional<ClaimExchange::Expected> ClaimExchange::Next(Epoch newest, TimePoint now)
{
    for (Series &series : _series)
    {
        Fire(series, now);
    }
    const auto in = NextEpoch(newest, now);
    if (!in)
    {
        return std::nullopt;
    }
    bool isAsking = *in == newest && _initial.IsDue(now);
    Expected next{.In = *in};
    next.WithCertificate = isAsking || (_certificate && _certificate->first == *in);
    for (const Series &series : _series)
    {
        for (const auto &[session, question] : series.Questions)
        {
            if (IsAsked(question, *in, isAsking, now))
            {
                isAsking = true;
                next.WithCertificate |= question.Of != Standing::Proven;
            }
        }
    }
    for (const auto &[session, answer] : _pending)
    {
        if (answer.In == *in)
        {
            ++next.Answers;
            next.WithCertificate |= answer.By != Standing::Proven;
        }
    }
    return next;
}

std::optional<ClaimExchange::Outgoing> ClaimExchange::TakeDue(Epoch newest, TimePoint now)
{
    const auto next = Next(newest, now);
    if (!next)
    {
        return std::nullopt;
    }
    Outgoing claim{.In = next->In, .WithCertificate = next->WithCertificate};
    if (claim.In == newest && _initial.IsDue(now))
    {
        claim.Challenge = CurrentNonce(now);
        _initial.Done(now);
    }
    if (_certificate && _certificate->first == claim.In)
    {
        _certificate.reset();
    }
    TakeQuestions(claim, now);
    TakeAnswers(claim, now);
    if (claim.Challenge != Nonce{})
    {
        _askedIn = {claim.In, now};
    }
    if (claim.WithCertificate)
    {
        _certificateNotBefore = now + QuickRetry;
    }
    return claim;
}

void ClaimExchange::TakeQuestions(Outgoing &claim, TimePoint now)
{
    for (Series &series : _series)
    {
        for (auto &[session, question] : series.Questions)
        {
            if (IsAsked(question, claim.In, claim.Challenge != Nonce{}, now))
            {
                claim.Challenge = CurrentNonce(now);
                question.AskedAt = now;
                question.IsWaiting = false;
                question.Left -= question.Of == Standing::Unknown ? 1 : 0;
            }
        }
    }
}

void ClaimExchange::TakeAnswers(Outgoing &claim, TimePoint now)
{
    bool isAnyUnproven = false;
    for (auto each = _pending.begin(); each != _pending.end();)
    {
        if (each->second.In != claim.In)
        {
            ++each;
            continue;
        }
        const Pending &answer = each->second;
        claim.Answers.push_back(answer.Of);
        isAnyUnproven |= answer.By != Standing::Proven;
        const Answered *const before = _answered.Find(each->first);
        Answered after = before != nullptr && before->Of == answer.Of ? *before : Answered{};
        if (after.Of == answer.Of)
        {
            after.Gap.Next();
        }
        after.Of = answer.Of;
        after.At = now;
        _answered.Put(each->first, after);
        each = _pending.erase(each);
    }
    if (!isAnyUnproven)
    {
        return;
    }
    if (now - _unprovenAt >= Quiet)
    {
        _unprovenGap.Reset();
    }
    _unprovenAt = now;
    _unprovenNotBefore = now + _unprovenGap.Next();
}

// Empty, and so no question, if there are no random bytes.
Nonce ClaimExchange::CurrentNonce(TimePoint now)
{
    if (_current == Nonce{} || now - _currentSince >= NonceAge)
    {
        _current = _nonce();
        _currentSince = now;
        if (_current != Nonce{})
        {
            _challenges.Set(_current, now);
        }
    }
    return _current;
}

std::size_t ClaimExchange::Size() const
{
    return _series[0].Questions.size() + _series[1].Questions.size() + _pending.size() + _answered.Size() +
           _refused.Size();
}

}  // namespace Rabit::Envelope
