// The small parts below all others.
#include <gtest/gtest.h>
#include <rabit/base/Assert.h>
#include <rabit/base/Backoff.h>
#include <rabit/base/Earliest.h>
#include <rabit/base/Fnv1a.h>
#include <rabit/base/ListedNames.h>
#include <rabit/base/LittleEndian.h>
#include <rabit/base/NaturalOrder.h>
#include <rabit/base/NumberIn.h>
#include <rabit/base/Printable.h>
#include <rabit/base/UtcText.h>
#include <rabit/base/WireBytes.h>
#include <rabit/base/WithoutByteOrderMark.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace
{

using namespace std::chrono_literals;

// [backoff]
TEST(BaseExample, QuestionsAreRepeatedEverMoreSeldom)
{
    Rabit::Backoff pause({.First = 1s, .Longest = 3s});
    EXPECT_EQ(pause.Next(), 1s);
    EXPECT_EQ(pause.Next(), 2s);
    EXPECT_EQ(pause.Next(), 3s);

    using Time = std::chrono::nanoseconds;
    Rabit::BackoffTimer<Time> timer({.First = 1s, .Longest = 3s});
    timer.Begin(Time(10s));
    EXPECT_TRUE(timer.IsDue(10s));
    timer.Done(10s);
    EXPECT_EQ(timer.Due(), Time(11s));
    EXPECT_EQ(Rabit::Earliest<Time>({timer.Due(), std::nullopt}), Time(11s));
}
// [/backoff]

// [bytes]
TEST(BaseExample, NumbersAndBytes)
{
    std::vector<std::uint8_t> bytes;
    Rabit::LittleEndian::Put(std::uint32_t{258}, bytes);
    EXPECT_EQ(bytes[1], 1);
    EXPECT_EQ(Rabit::NumberIn<int>("42"), 42);
    EXPECT_FALSE(Rabit::NumberIn<int>("42 m"));
    EXPECT_EQ(Rabit::Fnv1a().Add(std::string_view("uav1")).Sum(),
              Rabit::Fnv1a().Add(std::string_view("uav1")).Sum());
    EXPECT_EQ(Rabit::UtcText(std::uint64_t{0}), "1970-01-01T00:00:00.000Z");
    RABIT_ASSERT(bytes.size() == 4);
}
// [/bytes]

// [wire]
TEST(BaseExample, FieldsAreReadFromUntrustedBytes)
{
    const std::uint64_t count = 300;
    const std::string_view name = "uav1";
    std::vector<std::uint8_t> bytes(Rabit::VarintSize(count) + sizeof(std::uint32_t) + 1 + name.size());
    Rabit::WireWriter writer(bytes);
    writer.Varint(count);
    writer.Fixed(std::uint32_t{7});
    writer.Name(name);

    Rabit::WireReader whole(bytes);
    EXPECT_EQ(whole.Varint(1000), count);
    EXPECT_EQ(whole.Fixed<std::uint32_t>(), 7u);
    EXPECT_EQ(whole.Name(), name);
    EXPECT_TRUE(whole.IsAtEnd());

    // The count is too large here, so nothing behind it is read.
    Rabit::WireReader refused(bytes);
    EXPECT_EQ(refused.Varint(299), 0u);
    EXPECT_EQ(refused.Name(), "");
    EXPECT_FALSE(refused.IsGood());
}
// [/wire]

// [printable]
TEST(BaseExample, TextOfTheNetworkStaysOneLineOfALog)
{
    EXPECT_EQ(Rabit::Printable("uav1\nroot: all is well\x1b[2J"), "uav1?root: all is well?[2J");
    EXPECT_EQ(Rabit::Printable("a name that is too long", 9), "a name...");
}
// [/printable]

TEST(BaseExample, NamesAreListedForPeople)
{
    EXPECT_EQ(Rabit::ListedNames(std::vector<std::string>{"Pose", "Health"}), "`Pose`, `Health`");
    const std::vector<int> cells{1, 2, 3, 4, 5, 6, 7, 8};
    EXPECT_EQ(Rabit::ListedNames(cells, [](int cell) { return std::to_string(cell); }),
              "`1`, `2`, `3`, `4`, `5`, `6` and 2 more");
}

TEST(BaseExample, NamesInNaturalOrderAndTextWithoutAMark)
{
    const std::set<std::string, Rabit::NaturalOrder> nodes{"uav10", "uav2"};
    EXPECT_EQ(*nodes.begin(), "uav2");
    EXPECT_EQ(Rabit::WithoutByteOrderMark("\xEF\xBB\xBFnode: uav1"), "node: uav1");
}

}  // namespace
