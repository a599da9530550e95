// The certificate with which the page shows who serves it.
#pragma once

#include <ctime>
#include <string>
#include <vector>

namespace Ground
{

// What a certificate is for: names and numerical addresses at which the page is opened.
struct WebNames
{
    std::vector<std::string> Names;
    std::vector<std::string> Addresses;
};

// A new key, as PEM. All of these throw Rabit::Keys::KeysError.
std::string MakeWebKey();
// One that is signed with its own key: a browser asks before it believes it. As PEM. Good from a day before
// now, for clocks that are slow.
std::string MakeWebCertificate(const std::string &key, const WebNames &names, std::time_t now);

// Why a page cannot be served with them, one line; empty if it can. `file` is what it names.
std::string WhyNotServe(const std::string &certificate, const std::string &key, const std::string &file,
                        std::time_t now);
// By which a person compares it with what the browser shows: SHA-256, as `AB:CD:...`.
std::string FingerprintOf(const std::string &certificate);
// The names in it, without patterns. None if it has none, or cannot be read.
std::vector<std::string> NamesIn(const std::string &certificate);

}  // namespace Ground
