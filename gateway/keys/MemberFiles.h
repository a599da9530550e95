#pragma once

#include <string>

namespace Rabit::Keys
{

// The files in a node's folder. All but the key are public.
struct MemberFiles
{
    explicit MemberFiles(const std::string &folder)
        : Certificate(folder + "/certificate"),
          Permissions(folder + "/permissions"),
          Authority(folder + "/authority"),
          Bulletin(folder + "/bulletin"),
          Key(folder + "/key")
    {
    }

    std::string Certificate;
    std::string Permissions;
    std::string Authority;  // its public key
    std::string Bulletin;   // the newest ones, oldest first
    std::string Key;        // secret: both private keys
};

// Labels of the armoured files.
inline constexpr const char *CertificateLabel = "RABIT CERTIFICATE";
inline constexpr const char *PermissionsLabel = "RABIT PERMISSIONS";
inline constexpr const char *BulletinLabel = "RABIT BULLETIN";
inline constexpr const char *RequestLabel = "RABIT REQUEST";

}  // namespace Rabit::Keys
