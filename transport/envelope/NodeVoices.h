#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <utility>

#include "common/RecentMap.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// Finds nodes that live twice on one path: two sessions of one name speak in turn. A node that starts again
// speaks in one session, and then in another one. Bounded. Time is passed in. Not thread-safe.
class NodeVoices
{
public:
    // Both sessions speak within this time.
    static constexpr std::chrono::seconds InTurn{3};
    static constexpr std::size_t Most = 1024;

    enum class Verdict
    {
        One,
        Twice,           // one certificate in two sessions
        TwoCertificates  // of one name
    };
    Verdict Heard(const std::string &name, SessionTag session, const Hash &certificate, TimePoint now)
    {
        const Voice *const known = _voices.Find(name);
        Voice voice = known == nullptr ? Voice{} : *known;
        Verdict verdict = Verdict::One;
        if (voice.Last != session)
        {
            if (voice.Before == session && now - voice.BeforeAt <= InTurn)
            {
                verdict = voice.Certificate == certificate ? Verdict::Twice : Verdict::TwoCertificates;
            }
            voice.Before = std::exchange(voice.Last, session);
            voice.BeforeAt = voice.LastAt;
            voice.Certificate = certificate;
        }
        voice.LastAt = now;
        _voices.Put(name, voice);
        return verdict;
    }
    std::size_t Size() const { return _voices.Size(); }

private:
    struct Voice
    {
        SessionTag Last = 0;
        TimePoint LastAt{};
        Hash Certificate{};  // of the last one
        SessionTag Before = 0;
        TimePoint BeforeAt{};
    };

    RecentMap<std::string, Voice> _voices{Most};
};

}  // namespace Rabit::Envelope
