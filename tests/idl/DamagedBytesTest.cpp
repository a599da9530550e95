#include "SampleTest.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <random>

namespace
{

// A copy whose end is the end of an allocation, so that AddressSanitizer sees a read past it.
std::vector<std::uint8_t> Exactly(const std::vector<std::uint8_t> &bytes, std::size_t size)
{
    std::vector<std::uint8_t> copy;
    copy.reserve(size);
    copy.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    return copy;
}

TEST_EACH_SAMPLE(DamagedBytes, TruncatedAtEveryLengthIsRefused)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    const std::size_t padding = bytes[3];
    const auto target = type->Create();
    std::array<std::uint8_t, 16> hash{};
    for (std::size_t size = 0; size < bytes.size() - padding; ++size)
    {
        const std::vector<std::uint8_t> less = Exactly(bytes, size);
        EXPECT_FALSE(type->Deserialize(less, *target)) << size << " of " << bytes.size() << " bytes";
        EXPECT_FALSE(type->KeyHashOf(less, hash)) << size << " of " << bytes.size() << " bytes";
    }
    EXPECT_TRUE(type->Deserialize(Exactly(bytes, bytes.size() - padding), *target))
        << "padding is not needed";
}

TEST_EACH_SAMPLE(DamagedBytes, MoreThanPaddingBehindTheSampleIsRefused)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> bytes = BytesOf(message);
    const auto target = type->Create();
    bytes.resize(bytes.size() + 4);
    EXPECT_FALSE(type->Deserialize(bytes, *target));
}

TEST_EACH_SAMPLE(DamagedBytes, UnknownEncodingIsRefused)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const auto target = type->Create();
    for (int identifier = 2; identifier < 0x10000; ++identifier)
    {
        std::vector<std::uint8_t> bytes = BytesOf(message);
        bytes[0] = static_cast<std::uint8_t>(identifier >> 8);
        bytes[1] = static_cast<std::uint8_t>(identifier);
        ASSERT_FALSE(type->Deserialize(bytes, *target)) << identifier;
        identifier += identifier < 64 ? 0 : 250;
    }
}

// Any bytes are either refused or a value that encodes again; Scan and Read agree on which.
TEST_EACH_SAMPLE(DamagedBytes, GarbledBytesAreRefusedOrAreAValue)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    std::mt19937 random(20240607U);
    const auto below = [&](std::size_t limit) { return random() % limit; };
    const auto target = type->Create();
    for (int round = 0; round < 4000; ++round)
    {
        std::vector<std::uint8_t> garbled = Exactly(bytes, bytes.size());
        const std::size_t changes = 1 + below(4);
        for (std::size_t i = 0; i < changes; ++i)
        {
            static constexpr std::uint8_t nasty[] = {0x00, 0x01, 0x7f, 0x80, 0xff};
            garbled[1 + below(garbled.size() - 1)] =
                below(2) == 0 ? static_cast<std::uint8_t>(random()) : nasty[below(sizeof nasty)];
        }
        if (below(4) == 0)
        {
            garbled = Exactly(garbled, below(garbled.size() + 1));
        }
        const bool decodes = type->Deserialize(garbled, *target);
        if (decodes)
        {
            const std::vector<std::uint8_t> again = BytesOf(*target);
            const auto second = type->Create();
            ASSERT_TRUE(type->Deserialize(again, *second)) << "round " << round;
            ASSERT_EQ(BytesOf(*second), again) << "round " << round;
        }
        std::array<std::uint8_t, 16> hash{};
        ASSERT_EQ(type->KeyHashOf(garbled, hash), decodes && type->HasKey()) << "round " << round;
    }
}

TEST_EACH_SAMPLE(DamagedBytes, RandomBytesAreRefusedOrAreAValue)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::mt19937 random(7U);
    const auto target = type->Create();
    for (int round = 0; round < 2000; ++round)
    {
        std::vector<std::uint8_t> bytes(random() % 200);
        for (std::uint8_t &byte : bytes)
        {
            byte = static_cast<std::uint8_t>(random() % 3 == 0 ? random() : random() % 4);
        }
        if (bytes.size() >= 4)
        {
            bytes[0] = 0;
            bytes[1] = static_cast<std::uint8_t>(random() % 2);
        }
        if (type->Deserialize(bytes, *target))
        {
            ASSERT_FALSE(BytesOf(*target).empty()) << "round " << round;
        }
    }
}

}  // namespace
