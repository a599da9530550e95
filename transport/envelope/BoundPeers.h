#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

#include "envelope/Certificate.h"
#include "envelope/Permissions.h"
#include "envelope/Session.h"
#include "envelope/Types.h"

namespace Rabit::Envelope
{

// A session that was proven, and whose list of permissions is known.
struct BoundPeer
{
    SessionTag Session = 0;
    std::string Name;
    Serial Number = 0;
    CertificateRole Role = CertificateRole::Node;
    std::shared_ptr<const Permissions> List;
    bool HasEnded = false;  // its certificate was revoked
};

// Which certificate speaks by which GUID prefix, for the guard. A prefix stays with its first certificate,
// also when that is revoked: vendors remember writers for hours, and would take what another node sends in
// their names. Bounded. Thread-safe.
class BoundPeers
{
public:
    static constexpr std::size_t Most = 4096;  // prefixes

    // True if the session's prefixes are bound to its certificate.
    bool Has(const Session &session) const;
    // Binds the prefixes of a session that was proven. `isGone`: true for sessions that have ended; asked
    // only if there are many. Returns false if a prefix is bound to another certificate, or if there are too
    // many all the same.
    bool Bind(const Session &session, SessionTag tag, std::shared_ptr<const Permissions> list,
              const std::function<bool(SessionTag)> &isGone);
    // Null: nobody speaks by that prefix.
    std::shared_ptr<const BoundPeer> Find(const Rtps::GuidPrefix &prefix) const;
    // Nobody speaks by the prefixes of these any more.
    void EndIf(const std::function<bool(const BoundPeer &)> &is);
    std::size_t Size() const;

private:
    mutable std::mutex _mutex;
    std::map<Rtps::GuidPrefix, std::shared_ptr<const BoundPeer>> _peers;
};

}  // namespace Rabit::Envelope
