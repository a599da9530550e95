#include "keys/Secret.h"

#include <rabit/keys/KeysError.h>

#include <openssl/crypto.h>

#include <algorithm>
#include <string>

namespace Rabit::Keys
{

Secret::Secret(std::string_view text)
{
    Resize(text.size());
    std::copy(text.begin(), text.end(), _bytes.begin());
}

Secret::~Secret()
{
    OPENSSL_cleanse(_bytes.data(), _bytes.size());
}

void Secret::Resize(std::size_t size)
{
    if (size == 0 || size > LongestPassphrase)
    {
        throw KeysError("no passphrase: 1 to " + std::to_string(LongestPassphrase) + " bytes are expected");
    }
    _size = size;
}

}  // namespace Rabit::Keys
