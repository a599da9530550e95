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

// Whether peers are who they say, by TransportSettings::Security; without it all are. Thread-safe.
class PeerProof
{
public:
    static constexpr std::size_t PrefixSize = 12;

    PeerProof(const TransportSettings &settings, std::shared_ptr<SessionLog> log)
        : _security(settings.Security), _log(std::move(log))
    {
    }
    bool IsWanted() const { return _security.has_value(); }
    // Whether the one whose GUID begins so may call itself that; logs it if not.
    bool MayBe(const std::string &node, std::span<const std::uint8_t, PrefixSize> prefix) const;
    // What the other one, which calls itself that, announces of its own protection; logs it if it differs.
    void Compare(const std::string &node, bool encrypts) const;
    // The vendor has not accepted the certificate or the permissions of one that calls itself that; empty if
    // that is not known.
    void Refused(const std::string &node) const;

private:
    const std::optional<TransportSecurity> _security;
    const std::shared_ptr<SessionLog> _log;
};

}  // namespace Rabit
