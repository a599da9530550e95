// Counts the allocations of encoding and decoding. A program of its own, because it replaces operator new.
#include "SampleTest.h"

#include "growth.idl.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <iterator>
#include <new>

namespace
{

thread_local std::size_t allocations = 0;
thread_local std::size_t allocatedBytes = 0;

void *Counted(std::size_t size)
{
    ++allocations;
    allocatedBytes += size;
    void *memory = std::malloc(size == 0 ? 1 : size);
    if (memory == nullptr)
    {
        throw std::bad_alloc();
    }
    return memory;
}

}  // namespace

void *operator new(std::size_t size)
{
    return Counted(size);
}
void *operator new[](std::size_t size)
{
    return Counted(size);
}
void operator delete(void *memory) noexcept
{
    std::free(memory);
}
void operator delete[](void *memory) noexcept
{
    std::free(memory);
}
void operator delete(void *memory, std::size_t) noexcept
{
    std::free(memory);
}
void operator delete[](void *memory, std::size_t) noexcept
{
    std::free(memory);
}

namespace
{

TEST_EACH_SAMPLE(Allocation, EncodingAllocatesNothing)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    std::vector<std::uint8_t> buffer(type->SerializedSize(message));
    const std::size_t before = allocations;
    const std::size_t size = type->SerializedSize(message);
    const std::size_t written = type->Serialize(message, buffer);
    EXPECT_EQ(allocations, before);
    EXPECT_EQ(written, size);
}

TEST_EACH_SAMPLE(Allocation, DecodingTheSameAgainAllocatesNothing)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    const auto target = type->Create();
    ASSERT_TRUE(type->Deserialize(bytes, *target));
    const std::size_t before = allocations;
    const bool decoded = type->Deserialize(bytes, *target);
    EXPECT_EQ(allocations, before);
    EXPECT_TRUE(decoded);
}

TEST_EACH_SAMPLE(Allocation, KeyHashAllocatesNothing)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    std::array<std::uint8_t, 16> hash{};
    const std::size_t before = allocations;
    const bool hashed = type->KeyHashOf(bytes, hash);
    EXPECT_EQ(allocations, before);
    EXPECT_EQ(hashed, type->HasKey());
}

// A length that promises much more than the bytes hold must not be trusted: every 4 bytes of the sample in
// turn become a huge number.
TEST_EACH_SAMPLE(Allocation, LengthsFromTheWireAreNotBelieved)
{
    const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(message);
    const std::vector<std::uint8_t> bytes = BytesOf(message);
    for (std::size_t at = 4; at + 4 <= bytes.size() && at < 600; at += 4)
    {
        for (const std::uint32_t length : {0xffffffffU, 0x7fffffffU, 0x10000000U, 0x00100000U})
        {
            std::vector<std::uint8_t> garbled = bytes;
            for (std::size_t i = 0; i < 4; ++i)
            {
                garbled[at + i] = static_cast<std::uint8_t>(length >> (8 * i));
            }
            const auto target = type->Create();
            const std::size_t before = allocatedBytes;
            type->Deserialize(garbled, *target);
            // An element is at most 200 times larger in memory than on the wire (a message inside a message).
            ASSERT_LT(allocatedBytes - before, 200 * bytes.size() + 1000) << "at byte " << at;
        }
    }
}

// Returns the most bytes that decoding may allocate for a sample, whatever its type and contents
// (MessageType.h).
std::size_t MostFor(std::size_t sampleSize)
{
    return 256 * sampleSize + 65536;
}

// A sample that begins with the length of a sequence and goes on with one byte, again and again.
std::vector<std::uint8_t> Bomb(std::uint32_t length, std::uint8_t filling, std::size_t size)
{
    std::vector<std::uint8_t> bytes(size, filling);
    const std::uint8_t head[] = {0, 1, 0, 0};
    std::copy(std::begin(head), std::end(head), bytes.begin());
    for (std::size_t i = 0; i < 4; ++i)
    {
        bytes[4 + i] = static_cast<std::uint8_t>(length >> (8 * i));
    }
    return bytes;
}

TEST(DecodingBomb, OfNoShapeAllocatesMoreThanTheBytesAccountFor)
{
    for (const Rabit::MessageType *type :
         {&Growth::Sparses::IdlType(), &Growth::Heavies::IdlType(), &Growth::Grids::IdlType(),
          &Growth::Wordies::IdlType(), &Growth::Messages::IdlType(), &Growth::Nested::IdlType(),
          &Growth::Rows::IdlType(), &Growth::Texts::IdlType()})
    {
        for (const std::size_t size : {16U, 200U, 4000U})
        {
            for (std::uint32_t length = 1; length < size; length = length * 3 / 2 + 1)
            {
                for (std::uint8_t filling = 0; filling < 4; ++filling)
                {
                    const std::vector<std::uint8_t> bytes = Bomb(length, filling, size);
                    const auto target = type->Create();
                    const std::size_t before = allocatedBytes;
                    type->Deserialize(bytes, *target);
                    ASSERT_LE(allocatedBytes - before, MostFor(size))
                        << type->Name() << ", " << length << " elements in " << size << " bytes";
                }
            }
        }
    }
}

TEST(DecodingBomb, IsNotWhatManySmallUnionsAreThatCouldBeLarge)
{
    Growth::Sparses message;
    message.list.resize(20000);
    for (Growth::Sparse &one : message.list)
    {
        one._default();
    }
    std::array<std::uint8_t, 32768> page{};
    page[100] = 7;
    message.list[3].page(page);
    Growth::Sparses read;
    ASSERT_TRUE(Growth::Sparses::IdlType().Deserialize(BytesOf(message), read));
    EXPECT_EQ(read, message);
}

TEST(DecodingBomb, OfMessagesInsideMessagesIsRefusedAndAFewOfThemAreNot)
{
    Growth::Nested message;
    message.list.resize(100);
    const auto target = Growth::Nested::IdlType().Create();
    EXPECT_TRUE(Growth::Nested::IdlType().Deserialize(BytesOf(message), *target));
    message.list.resize(10000);
    EXPECT_FALSE(Growth::Nested::IdlType().Deserialize(BytesOf(message), *target));
}

}  // namespace
