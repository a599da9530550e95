#include "WebSecrets.h"

#include "WebAddress.h"

#include <rabit/keys/AccessToken.h>
#include <rabit/keys/KeysError.h>

#include <keys/KeyFiles.h>

#include <filesystem>

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
}  // namespace

WebSecrets MakeWebToken()
{
    try
    {
        return {{}, {}, Keys::MakeAccessToken()};
    }
    catch (const Keys::KeysError &error)
    {
        throw WebServerError(error.what());
    }
}

WebSecrets MakeWebSecrets(const WebNames &names, std::time_t now)
{
    try
    {
        WebSecrets secrets;
        secrets.Key = MakeWebKey();
        secrets.Certificate = MakeWebCertificate(secrets.Key, names, now);
        secrets.Token = Keys::MakeAccessToken();
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
        secrets.Token = Keys::AccessTokenIn(token, mayWrite);
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
