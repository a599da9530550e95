#include "keys/Passphrase.h"

#include <fcntl.h>
#include <openssl/crypto.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <memory>

#include "keys/KeyFiles.h"
#include "keys/KeysError.h"

namespace Rabit::Keys
{
namespace
{

constexpr const char *Variable = "RABIT_KEYS_PASSPHRASE";

// OpenSSL would take standard input in place of a terminal.
bool HasTerminal()
{
    const int terminal = ::open("/dev/tty", O_RDWR | O_CLOEXEC);
    if (terminal >= 0)
    {
        ::close(terminal);
    }
    return terminal >= 0;
}

}  // namespace

std::optional<std::string> GivenPassphrase(const std::string &file)
{
    if (!file.empty())
    {
        return ReadPassphrase(file);
    }
    const char *text = std::getenv(Variable);
    if (text == nullptr)
    {
        return std::nullopt;
    }
    if (const std::string passphrase = text; !passphrase.empty() && passphrase.size() <= LongestPassphrase)
    {
        return passphrase;
    }
    throw KeysError(std::string(Variable) + " is no passphrase: 1 to " + std::to_string(LongestPassphrase) +
                    " bytes are expected");
}

std::string TypedPassphrase(const std::string &prompt, bool isNew)
{
    if (!HasTerminal())
    {
        throw KeysError(
            "no passphrase is given, and no terminal is there to ask for it; name a file with "
            "--passphrase-file, or set " +
            std::string(Variable));
    }
    std::array<char, LongestPassphrase + 1> typed{};
    // Restores the terminal also after Ctrl-C.
    const int result =
        EVP_read_pw_string(typed.data(), static_cast<int>(typed.size()), prompt.c_str(), isNew ? 1 : 0);
    std::string passphrase = typed.data();
    OPENSSL_cleanse(typed.data(), typed.size());
    if (result != 0)
    {
        throw KeysError(isNew ? "no passphrase was typed, or not the same one twice"
                              : "no passphrase was typed");
    }
    if (passphrase.empty())
    {
        throw KeysError("an empty passphrase protects nothing");
    }
    return passphrase;
}

AskPassphrase PassphraseFrom(const std::string &file)
{
    const auto known = std::make_shared<std::optional<std::string>>();
    return [file, known](const std::string &key)
    {
        if (!*known)
        {
            *known = GivenPassphrase(file);
        }
        if (!*known)
        {
            *known = TypedPassphrase("Passphrase of " + key + ": ", false);
        }
        return **known;
    };
}

}  // namespace Rabit::Keys
