// Samples of generated classes and of types that are known only at run time.
#include "EveryKind.h"
#include "gateway.idl.h"
#include "uav.idl.h"

namespace
{

template <typename Message>
std::vector<std::uint8_t> Written(const Message &message)
{
    const Rabit::MessageType &type = Message::IdlType();
    std::vector<std::uint8_t> bytes(type.SerializedSize(message));
    bytes.resize(type.Serialize(message, bytes));
    return bytes;
}

// A class writes again whatever it accepts, and accepts that, too, as the same value.
template <typename Message>
void Read(const std::vector<std::uint8_t> &bytes)
{
    const Rabit::MessageType &type = Message::IdlType();
    Message message;
    std::array<std::uint8_t, 16> hash{};
    type.KeyHashOf(bytes, hash);
    if (type.Deserialize(bytes, message))
    {
        const std::vector<std::uint8_t> again = Written(message);
        Message same;
        Fuzz::Require(type.Deserialize(again, same) && Written(same) == again);
    }
}

}  // namespace

// Byte 0: the type.
int Fuzz::OneInput(const std::uint8_t *data, std::size_t size)
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
