// Ed25519 and X25519 keys (RFC 8032, RFC 7748) as files have them: PEM, so that `openssl pkey` reads them.
#pragma once

#include <string>
#include <string_view>

#include "envelope/AgreementKey.h"
#include "envelope/SecretKey.h"
#include "envelope/SigningKey.h"
#include "envelope/Types.h"
#include "envelope/VerifyingKey.h"
#include "keys/PrivateKeyPem.h"

namespace Rabit::Keys
{

// Functions here throw KeysError; those that read name `file`.

Envelope::SecretKey RandomSecret();

Envelope::SigningKey SigningKeyOf(const Envelope::SecretKey &seed);
Envelope::AgreementKey AgreementKeyOf(const Envelope::SecretKey &bytes);
Envelope::VerifyingKey VerifyingKeyOf(const Envelope::PublicKey &key);

// An Ed25519 private key; encrypted unless the passphrase is empty.
std::string SigningKeyPem(const Envelope::SecretKey &seed, std::string_view passphrase = {});
Envelope::SecretKey ReadSigningKey(std::string_view pem, const std::string &file,
                                   const AskPassphrase &ask = {});
// An Ed25519 public key.
std::string PublicKeyPem(const Envelope::PublicKey &key);
Envelope::PublicKey ReadPublicKey(std::string_view pem, const std::string &file);

// Both private keys of a node.
struct MemberSecrets
{
    static MemberSecrets Random();
    // Reads what Pem writes: the signing key, then the other one.
    static MemberSecrets Read(std::string_view pem, const std::string &file);
    std::string Pem() const;

    Envelope::SecretKey Signing;
    Envelope::SecretKey Agreement;
};

// Both public keys of a node.
struct MemberPublic
{
    static MemberPublic Of(const MemberSecrets &secrets);
    // Returns the SHA-256 hash of both, in hex digits, for people to compare.
    std::string Fingerprint() const;
    bool operator==(const MemberPublic &) const = default;

    Envelope::PublicKey Signing{};
    Envelope::PublicKey Agreement{};
};

}  // namespace Rabit::Keys
