#pragma once

#include <rabit/transport/Transport.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/SessionLog.h"

namespace Rabit
{

// Checks that peers are the nodes that they say, by TransportSettings::Security; without security all pass.
// Thread-safe.
class PeerProof
{
public:
    static constexpr std::size_t PrefixSize = 12;

    PeerProof(const TransportSettings &settings, std::shared_ptr<SessionLog> log)
        : _security(settings.Security), _log(std::move(log))
    {
    }
    bool IsWanted() const { return _security.has_value(); }
    // Returns true if the participant whose GUID begins with `prefix` may call itself `node`; logs it if not.
    bool MayBe(const std::string &node, std::span<const std::uint8_t, PrefixSize> prefix) const;
    // Compares the peer's announced protection of discovery with this node's; logs a difference.
    void Compare(const std::string &node, bool encrypts) const;
    // Logs that the vendor has refused the certificate or the permissions of a participant that calls itself
    // `node`; `node` is empty if its name is unknown.
    void Refused(const std::string &node) const;
    // Logs that the authentication of a participant has come to no end and begins anew; `node` as above.
    void Unfinished(const std::string &node) const;

private:
    const std::optional<TransportSecurity> _security;
    const std::shared_ptr<SessionLog> _log;
};

}  // namespace Rabit
