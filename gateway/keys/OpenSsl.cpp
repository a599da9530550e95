#include "keys/OpenSsl.h"

#include <openssl/err.h>

#include <array>
#include <utility>

namespace Rabit::Keys
{

int NoPassphrase(char * /*buffer*/, int /*size*/, int /*isNew*/, void * /*data*/)
{
    return -1;
}

std::string OpenSslError()
{
    const unsigned long code = ERR_get_error();
    ERR_clear_error();
    std::array<char, 256> text{};
    ERR_error_string_n(code, text.data(), text.size());
    const char *reason = ERR_reason_error_string(code);
    return code == 0 ? "no reason is known" : reason != nullptr ? reason : text.data();
}

BioPtr BioOf(std::string_view text)
{
    return Must(BioPtr(BIO_new_mem_buf(text.data(), static_cast<int>(text.size()))), "read a text");
}

BioPtr EmptyBio()
{
    return Must(BioPtr(BIO_new(BIO_s_mem())), "write a text");
}

std::string TextOf(BIO &bio)
{
    char *data = nullptr;
    const long size = BIO_get_mem_data(&bio, &data);
    return size > 0 ? std::string(data, static_cast<std::size_t>(size)) : std::string();
}

}  // namespace Rabit::Keys
