// Samples of generated classes and of types that are known only at run time.
#include "EveryKind.h"
#include "gateway.idl.h"
#include "uav.idl.h"

namespace
{

// A class writes again whatever it accepts, and accepts that, too.
template <typename Message>
void Read(const std::vector<std::uint8_t> &bytes)
{
    const Rabit::MessageType &type = Message::IdlType();
    Message message;
    std::array<std::uint8_t, 16> hash{};
    type.KeyHashOf(bytes, hash);
    if (type.Deserialize(bytes, message))
    {
        std::vector<std::uint8_t> again(type.SerializedSize(message));
        again.resize(type.Serialize(message, again));
        Message same;
        Fuzz::Require(type.Deserialize(again, same));
    }
}

}  // namespace

// Byte 0: the type.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size)
{
    Fuzz::Input input(data, size);
    const unsigned choice = input.Byte() % 4;
    const std::vector<std::uint8_t> bytes(data + std::min<std::size_t>(1, size), data + size);
    if (choice == 1)
    {
        Read<Rabit::Gateway::Fleet>(bytes);
    }
    else if (choice == 2)
    {
        Read<Uav::Pose>(bytes);
    }
    else if (choice == 3)
    {
        Read<Uav::Picture>(bytes);
    }
    else
    {
        const auto &type = Fuzz::EveryKind();
        std::array<std::uint8_t, 16> hash{};
        type.KeyHashOf(bytes, hash);
        type.ToText(bytes);
        const auto normal = type.Normalized(bytes);
        if (normal)
        {
            Fuzz::Require(type.Normalized(*normal) == normal);
        }
        Fuzz::Require(normal.has_value() || !type.ToJson(bytes));
    }
    return 0;
}
