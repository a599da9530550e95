// What a page has that is not for everybody.
#pragma once

#include "WebCertificate.h"

#include <ctime>
#include <string>

namespace Ground
{

struct WebSecrets
{
    std::string Certificate;  // PEM; may be followed by those that lead to its authority
    std::string Key;          // PEM
    std::string Token;        // who shows it may look and command
};

// Fewer characters could be guessed.
inline constexpr std::size_t ShortestToken = 22;
inline constexpr std::size_t LongestToken = 128;

// 128 random bits.
std::string MakeWebToken();

// New ones, which are good until the program ends. Throws WebServerError.
WebSecrets MakeWebSecrets(const WebNames &names, std::time_t now);

// Those in a folder: `certificate.pem`, `private_key.pem` and `token`. What is not there is made there, for
// its owner alone, so that the next start has the same; without `mayWrite` it is made and not kept. Throws
// WebServerError for what cannot be used, or may be read by others than its owner.
WebSecrets WebSecretsIn(const std::string &folder, const WebNames &names, std::time_t now,
                        bool mayWrite = true);

}  // namespace Ground
