#include "keys/Armour.h"

#include <openssl/crypto.h>
#include <openssl/err.h>
#include <openssl/pem.h>

#include <memory>
#include <utility>

#include "keys/OpenSsl.h"

namespace Rabit::Keys
{
namespace
{

struct ArmourFree
{
    void operator()(void *memory) const { OPENSSL_free(memory); }
};

[[noreturn]] void ThrowNoBlock(const std::string &label, const std::string &file)
{
    throw KeysError(file + " is no `" + label + "`: it is damaged, or another file; copy it again");
}

}  // namespace

std::string Armoured(const std::string &label, std::span<const std::uint8_t> bytes)
{
    const BioPtr bio = EmptyBio();
    Must(PEM_write_bio(bio.get(), label.c_str(), "", bytes.data(), static_cast<long>(bytes.size())) > 0,
         "write a text");
    return TextOf(*bio);
}

std::vector<Bytes> BlocksIn(std::string_view text, const std::string &label, const std::string &file)
{
    const BioPtr bio = BioOf(text);
    std::vector<Bytes> blocks;
    ERR_clear_error();
    while (true)
    {
        char *name = nullptr;
        char *header = nullptr;
        unsigned char *data = nullptr;
        long size = 0;
        const bool isRead = PEM_read_bio(bio.get(), &name, &header, &data, &size) == 1;
        const std::unique_ptr<char, ArmourFree> ownName(name);
        const std::unique_ptr<char, ArmourFree> ownHeader(header);
        const std::unique_ptr<unsigned char, ArmourFree> ownData(data);
        if (!isRead)
        {
            break;
        }
        if (label != name || (header != nullptr && *header != '\0'))
        {
            ThrowNoBlock(label, file);
        }
        blocks.emplace_back(data, data + size);
    }
    const bool isEnd = ERR_GET_REASON(ERR_peek_last_error()) == PEM_R_NO_START_LINE;
    ERR_clear_error();
    if (!isEnd || blocks.empty())
    {
        ThrowNoBlock(label, file);
    }
    return blocks;
}

Bytes BlockIn(std::string_view text, const std::string &label, const std::string &file)
{
    std::vector<Bytes> blocks = BlocksIn(text, label, file);
    if (blocks.size() != 1)
    {
        ThrowNoBlock(label, file);
    }
    return std::move(blocks.front());
}

}  // namespace Rabit::Keys
