#include "WebSecrets.h"

#include "WebAddress.h"

#include <keys/KeyFiles.h>
#include <keys/KeysError.h>
#include <keys/OpenSsl.h>

#include <openssl/rand.h>

#include <boost/algorithm/hex.hpp>
#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <array>
#include <filesystem>
#include <iterator>

namespace Ground
{
namespace
{
namespace Keys = Rabit::Keys;

bool IsThere(const std::string &file)
{
    std::error_code ignored;
    return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
}

bool IsTokenCharacter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

void CheckToken(const std::string &token, const std::string &file)
{
    if (token.size() < ShortestToken || token.size() > LongestToken ||
        !std::all_of(token.begin(), token.end(), &IsTokenCharacter))
        throw WebServerError(file + " has no token: " + std::to_string(ShortestToken) + " to " +
                             std::to_string(LongestToken) +
                             " letters, digits, - and _, at random; remove it, and one is made");
}
}  // namespace

std::string MakeWebToken()
{
    std::array<unsigned char, 16> octets{};
    Keys::Must(RAND_bytes(octets.data(), static_cast<int>(octets.size())) == 1, "make a token");
    std::string token;
    boost::algorithm::hex_lower(octets, std::back_inserter(token));
    return token;
}

WebSecrets MakeWebSecrets(const WebNames &names, std::time_t now)
{
    try
    {
        WebSecrets secrets;
        secrets.Key = MakeWebKey();
        secrets.Certificate = MakeWebCertificate(secrets.Key, names, now);
        secrets.Token = MakeWebToken();
        return secrets;
    }
    catch (const Keys::KeysError &error)
    {
        throw WebServerError(error.what());
    }
}

WebSecrets WebSecretsIn(const std::string &folder, const WebNames &names, std::time_t now, bool mayWrite)
{
    const std::string certificate = folder + "/certificate.pem";
    const std::string key = folder + "/private_key.pem";
    const std::string token = folder + "/token";
    try
    {
        if (mayWrite && !IsThere(folder))
            Keys::MakeSecretFolder(folder);
        if (IsThere(certificate) && !IsThere(key))
            throw WebServerError(key + " is missing, the key of " + certificate);
        WebSecrets secrets;
        // The key comes first: an interrupted start leaves only a key, which the next start uses.
        secrets.Key = IsThere(key) ? Keys::ReadSecret(key) : MakeWebKey();
        if (mayWrite && !IsThere(key))
            Keys::WriteSecret(key, secrets.Key);
        secrets.Certificate =
            IsThere(certificate) ? Keys::ReadFile(certificate) : MakeWebCertificate(secrets.Key, names, now);
        if (mayWrite && !IsThere(certificate))
            Keys::WriteFile(certificate, secrets.Certificate);
        secrets.Token =
            IsThere(token) ? boost::algorithm::trim_copy(Keys::ReadSecret(token)) : MakeWebToken();
        CheckToken(secrets.Token, token);
        if (mayWrite && !IsThere(token))
            Keys::WriteSecret(token, secrets.Token + "\n");
        if (const std::string why = WhyNotServe(secrets.Certificate, secrets.Key, certificate, now);
            !why.empty())
            throw WebServerError(why);
        return secrets;
    }
    catch (const Keys::KeysError &error)
    {
        throw WebServerError(error.what());
    }
}

}  // namespace Ground
