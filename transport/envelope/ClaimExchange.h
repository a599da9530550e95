#pragma once

#include <rabit/base/Backoff.h>

#include <array>
#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/RecentMap.h"
#include "envelope/Claim.h"
#include "envelope/OwnChallenges.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Says when this session's claims go out, in which epoch, and with which answers and nonce.
//
// - At the start, claims go out at growing intervals until the first other session is proven.
// - A session that is heard and has to prove that it is live is asked: a claim with a nonce goes to all. It
//   is repeated at growing intervals while the session is heard. One claim asks all.
// - A claim that asks is answered. Answers wait a little, so one claim answers many. The same nonce of one
//   session is answered again no sooner than an answer may have been lost.
// - Recorded claims ask for answers as well. So answers to sessions that are not proven have a growing gap.
// - The certificate is left out if all sessions that the claim asks or answers have proven themselves: each
//   of them has answered a claim of this session, and so has the certificate.
//
// A session that sends in a former epoch is asked and answered in that epoch.
//
// A pure state machine. Time is passed in. Not thread-safe.
class ClaimExchange
{
public:
    // At the start.
    static constexpr std::chrono::milliseconds FirstClaim{100};
    static constexpr std::chrono::milliseconds LongestClaim{2000};
    static constexpr double ClaimFactor = 1.5;
    static constexpr int InitialClaims = 10;
    // Of questions. QuickRetries of them take 4.5 s: all are in vain once in 10,000 times where 40 % of the
    // datagrams are lost both ways. Afterwards the intervals grow on.
    static constexpr std::chrono::milliseconds FirstRetry{60};
    static constexpr std::chrono::milliseconds QuickRetry{200};
    static constexpr std::chrono::seconds LongestRetry{10};
    static constexpr double RetryFactor = 1.2;
    static constexpr int QuickRetries = 24;
    // Each session that is asked sends an answer, which takes its time on a thin channel: so long no question
    // is repeated.
    static constexpr std::chrono::milliseconds AnswerTakes{15};
    static constexpr std::chrono::milliseconds LongestAnswers{400};
    // Questions to a session of which nothing was verified, unless it is heard again.
    static constexpr int MostUnverified = 4;
    // A session that was not heard for this time is not asked, and after Forgotten its intervals begin anew.
    static constexpr std::chrono::seconds Patience{2};
    static constexpr std::chrono::seconds Forgotten{10};
    // From a claim that asks to the answer: others may ask as well.
    static constexpr std::chrono::milliseconds Gather{20};
    // From an answer to the next one to the same nonce.
    static constexpr std::chrono::milliseconds FirstAnswerGap{40};
    static constexpr std::chrono::milliseconds LongestAnswerGap{200};
    // From a claim that answers sessions that are not proven to the next such one.
    static constexpr std::chrono::milliseconds FirstUnprovenGap{20};
    static constexpr std::chrono::milliseconds LongestUnprovenGap{400};
    static constexpr double GapFactor = 1.5;
    // After this time without such a claim the gap is short again.
    static constexpr std::chrono::seconds Quiet{5};
    // A nonce is replaced when it is older and a question is due.
    static constexpr std::chrono::seconds NonceAge{5};
    // Sessions of each sort that are asked at one time, and sessions whose last answer is known.
    static constexpr std::size_t MostAsked = 256;
    static constexpr std::size_t MostAnswered = 1024;
    static constexpr std::size_t MostRefused = 256;

    // `nonce`: returns random bytes that are not zero.
    explicit ClaimExchange(std::function<Nonce()> nonce) : _nonce(std::move(nonce)) {}

    const OwnChallenges &Challenges() const { return _challenges; }

    void Begin(TimePoint now) { _initial.Begin(now); }

    enum class Standing
    {
        Unknown,  // anybody can invent such a session
        Claimed,  // not proven
        Proven    // at some time
    };
    // A datagram came that names a session which has to prove that it is live. `in`: the epoch in which it
    // can be asked.
    void Heard(SessionTag session, Standing standing, Epoch in, TimePoint now);
    // A claim asks this session. `standing`: Unknown if its signature was not verified.
    void Asked(SessionTag session, Standing standing, const Nonce &nonce, Epoch in, TimePoint now);
    // The session has proven that it is live.
    void Proven(SessionTag session, TimePoint now);
    // The session is never asked again: its certificate is revoked.
    void Refuse(SessionTag session);
    // A session lacks this session's certificate.
    void WantCertificate(Epoch in, TimePoint now);

    std::optional<TimePoint> Due() const;
    struct Outgoing
    {
        Epoch In = 0;
        Nonce Challenge{};
        std::vector<Nonce> Answers{};
        bool WithCertificate = false;
    };
    // The claim that TakeDue would return now; empty: none is due.
    struct Expected
    {
        Epoch In = 0;
        std::size_t Answers = 0;
        bool WithCertificate = false;
    };
    std::optional<Expected> Next(Epoch newest, TimePoint now);
    // Takes a claim that is due; empty: none is. `newest`: the epoch in which this session sends.
    std::optional<Outgoing> TakeDue(Epoch newest, TimePoint now);

    // Sessions that are remembered, for tests.
    std::size_t Size() const;

private:
    struct Question
    {
        Epoch In = 0;
        Standing Of = Standing::Unknown;
        TimePoint Heard{};
        TimePoint AskedAt{};
        bool IsWaiting = false;  // the question is due, and has not gone
        int Left = MostUnverified;
    };
    // GCC 12 takes the settings for uninitialized if an array of Series has them in place.
    static BackoffTimer<TimePoint> QuestionTimer()
    {
        return BackoffTimer<TimePoint>({FirstRetry, LongestRetry, RetryFactor, 0, QuickRetries, QuickRetry});
    }
    // Questions to sessions of one sort, which go together.
    struct Series
    {
        std::map<SessionTag, Question> Questions{};
        BackoffTimer<TimePoint> Retry = QuestionTimer();
        TimePoint Heard{};
    };
    struct Pending
    {
        Nonce Of{};
        Epoch In = 0;
        Standing By = Standing::Unknown;
        TimePoint Due{};
    };
    struct Answered
    {
        Nonce Of{};
        TimePoint At{};
        Backoff Gap{{FirstAnswerGap, LongestAnswerGap, GapFactor}};
    };

    static bool IsActive(const Series &series, const Question &question);
    static std::optional<TimePoint> DueOf(const Series &series);
    TimePoint DueOf(const Pending &answer) const;
    void Forget(Series &series, TimePoint now);
    TimePoint AnsweredBy(const Series &series) const;
    void Fire(Series &series, TimePoint now);
    std::optional<Epoch> NextEpoch(Epoch newest, TimePoint now) const;
    static bool IsAsked(const Question &question, Epoch in, bool isAsking, TimePoint now);
    void TakeQuestions(Outgoing &claim, TimePoint now);
    void TakeAnswers(Outgoing &claim, TimePoint now);
    Nonce CurrentNonce(TimePoint now);

    const std::function<Nonce()> _nonce;
    OwnChallenges _challenges;
    Nonce _current{};
    TimePoint _currentSince{};
    std::pair<Epoch, TimePoint> _askedIn{};  // the last question
    BackoffTimer<TimePoint> _initial{{FirstClaim, LongestClaim, ClaimFactor, InitialClaims}};
    std::array<Series, 2> _series{};  // of sessions that were proven at some time, and of others
    std::map<SessionTag, Pending> _pending;
    RecentMap<SessionTag, Answered> _answered{MostAnswered};
    RecentMap<SessionTag, bool> _refused{MostRefused};
    Backoff _unprovenGap{{FirstUnprovenGap, LongestUnprovenGap, GapFactor}};
    TimePoint _unprovenAt{};
    TimePoint _unprovenNotBefore{};
    // Somebody lacks the certificate: the epoch in which it goes, and when.
    std::optional<std::pair<Epoch, TimePoint>> _certificate;
    TimePoint _certificateNotBefore{};
};

}  // namespace Rabit::Envelope
