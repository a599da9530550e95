// The TLS certificate of the page.
#pragma once

#include <ctime>
#include <string>
#include <vector>

namespace Ground
{

// The names and numerical addresses of the page, for its certificate.
struct WebNames
{
    std::vector<std::string> Names;
    std::vector<std::string> Addresses;
};

// A new key, as PEM. All of these throw Rabit::Keys::KeysError.
std::string MakeWebKey();
// A self-signed certificate, as PEM: a browser asks before it accepts it. Valid from a day before `now`,
// for clocks that are slow.
std::string MakeWebCertificate(const std::string &key, const WebNames &names, std::time_t now);

// The reason why a page cannot be served with certificate and key, in one line that names `file`; empty if
// it can.
std::string WhyNotServe(const std::string &certificate, const std::string &key, const std::string &file,
                        std::time_t now);
// The fingerprint, for comparison with the one that the browser shows: SHA-256, as `AB:CD:...`.
std::string FingerprintOf(const std::string &certificate);
// The names in the certificate, without patterns. Empty if it has none, or cannot be read.
std::vector<std::string> NamesIn(const std::string &certificate);

}  // namespace Ground
