// The secrets of a page: certificate, key and token.
#pragma once

#include "WebCertificate.h"

#include <ctime>
#include <string>

namespace Ground
{

struct WebSecrets
{
    std::string Certificate;  // PEM; may be followed by its chain of certificates; empty: no TLS
    std::string Key;          // PEM; empty: no TLS
    std::string Token;        // gives access to view and command

    bool HasTls() const { return !Certificate.empty(); }
};

// A new token without TLS, for a page that only this machine reaches. Throws WebServerError.
WebSecrets MakeWebToken();

// New secrets, which are valid until the program ends. Throws WebServerError.
WebSecrets MakeWebSecrets(const WebNames &names, std::time_t now);

// The secrets in a folder: `certificate.pem`, `private_key.pem` and `token`. Missing files are made there,
// readable by their owner alone, so that the next start has the same; without `mayWrite` they are made in
// memory only. Throws WebServerError if a file is unusable, or readable by others than its owner.
WebSecrets WebSecretsIn(const std::string &folder, const WebNames &names, std::time_t now,
                        bool mayWrite = true);

}  // namespace Ground
