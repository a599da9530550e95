// A bulletin is published by the authority when it revokes a certificate: a new epoch, all revoked serials,
// and the new epoch's secret, sealed to each remaining node. Public. Numbers are little-endian:
//
//   offset  size  what
//   0       1     format, 1
//   1       2     epoch
//   3       32    X25519 public key that the authority made for this bulletin alone
//   35      2     r, the number of revoked serials
//   37      2     n, the number of nodes
//   39      4 r   revoked serials, rising
//   ...     52 n  for each node, by rising serial: serial (4); the secret, sealed (48)
//   ...     64    Ed25519 signature of the authority over "Rabit bulletin 1" and all before
//
// A secret is sealed by ChaCha20-Poly1305 with the nonce 0 and, authenticated, epoch and serial. Its key is
// HKDF(salt: both public keys, the bulletin's first; the X25519 secret of both; "Rabit bulletin 1", epoch,
// serial). So two certificates with one X25519 key have two keys here.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "envelope/AgreementKey.h"
#include "envelope/SigningKey.h"
#include "envelope/Types.h"
#include "envelope/VerifyingKey.h"

namespace Rabit::Envelope
{

constexpr std::size_t MostRevoked = 4096;
constexpr std::size_t MostBulletinNodes = 1024;

struct BulletinNode
{
    Serial Number = 0;
    PublicKey Agreement{};
};

// A bulletin that was read and verified. Refers to the bytes that it was read from.
class Bulletin
{
public:
    // Accepts any bytes; empty if they are no bulletin, or if the authority did not sign them.
    static std::optional<Bulletin> Read(std::span<const std::uint8_t> bytes, VerifyingKey &authority);
    // Returns the bytes of a bulletin. `once`: a random key, used for this bulletin alone. Empty if a serial
    // occurs twice, is both revoked and named, or is one of too many, if the epoch is 0, if a public key is
    // of low order, or if OpenSSL fails.
    static std::vector<std::uint8_t> Write(Envelope::Epoch epoch, std::vector<Serial> revoked,
                                           std::vector<BulletinNode> nodes, const SecretKey &secret,
                                           const AgreementKey &once, SigningKey &authority);

    Envelope::Epoch Epoch() const { return _epoch; }
    std::vector<Serial> Revoked() const;
    // The epoch's secret, for the owner of that certificate. Empty if the bulletin has none for it.
    std::optional<SecretKey> Secret(Serial number, const AgreementKey &key) const;

private:
    Bulletin() = default;

    Envelope::Epoch _epoch = 0;
    PublicKey _once{};
    std::span<const std::uint8_t> _revoked{};
    std::span<const std::uint8_t> _nodes{};
};

}  // namespace Rabit::Envelope
