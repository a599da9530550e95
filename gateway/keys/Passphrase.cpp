#include "keys/Passphrase.h"

#include <rabit/keys/KeysError.h>

#include <fcntl.h>
#include <openssl/evp.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <memory>

#include "keys/KeyFiles.h"

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

std::optional<Secret> GivenPassphrase(const std::string &file)
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
    try
    {
        return Secret(text);
    }
    catch (const KeysError &error)
    {
        throw KeysError(std::string(Variable) + " is " + error.what());
    }
}

Secret TypedPassphrase(const std::string &prompt, bool isNew)
{
    if (!HasTerminal())
    {
        throw KeysError(
            "no passphrase is given, and no terminal is there to ask for it; name a file with "
            "--passphrase-file, or set " +
            std::string(Variable));
    }
    Secret passphrase;
    // Restores the terminal also after Ctrl-C. Writes a zero behind the bytes, which its limit does not
    // count.
    if (EVP_read_pw_string(passphrase.Room(), static_cast<int>(LongestPassphrase), prompt.c_str(),
                           isNew ? 1 : 0) != 0)
    {
        throw KeysError(isNew ? "no passphrase was typed, or not the same one twice"
                              : "no passphrase was typed");
    }
    const std::size_t size = ::strnlen(passphrase.Room(), LongestPassphrase);
    if (size == 0)
    {
        throw KeysError("an empty passphrase protects nothing");
    }
    passphrase.Resize(size);
    return passphrase;
}

AskPassphrase PassphraseFrom(const std::string &file)
{
    const auto known = std::make_shared<std::optional<Secret>>();
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
