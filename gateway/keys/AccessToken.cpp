#include <rabit/keys/AccessToken.h>

#include <openssl/rand.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>

#include "keys/KeyFiles.h"
#include "keys/OpenSsl.h"

namespace Rabit::Keys
{

namespace
{

bool IsTokenCharacter(char c)
{
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' || c == '_';
}

std::string WithoutSpace(const std::string &text)
{
    constexpr const char *Space = " \t\r\n";
    const std::size_t begin = text.find_first_not_of(Space);
    return begin == std::string::npos ? "" : text.substr(begin, text.find_last_not_of(Space) + 1 - begin);
}

}  // namespace

std::string MakeAccessToken()
{
    constexpr const char *Digits = "0123456789abcdef";
    std::array<unsigned char, 16> octets{};
    Must(RAND_bytes(octets.data(), static_cast<int>(octets.size())) == 1, "make a token");
    std::string token;
    for (const unsigned char octet : octets)
    {
        token += {Digits[octet >> 4], Digits[octet & 15]};
    }
    return token;
}

std::string AccessTokenIn(const std::string &file, bool mayWrite)
{
    std::error_code ignored;
    if (!std::filesystem::exists(std::filesystem::symlink_status(file, ignored)))
    {
        const std::string token = MakeAccessToken();
        if (mayWrite)
        {
            WriteSecret(file, token + "\n");
        }
        return token;
    }
    const std::string token = WithoutSpace(ReadSecret(file));
    if (token.size() < ShortestToken || token.size() > LongestToken ||
        !std::all_of(token.begin(), token.end(), &IsTokenCharacter))
    {
        throw KeysError(file + " has no token: " + std::to_string(ShortestToken) + " to " +
                        std::to_string(LongestToken) +
                        " letters, digits, - and _, at random; remove it, and one is made");
    }
    return token;
}

}  // namespace Rabit::Keys
