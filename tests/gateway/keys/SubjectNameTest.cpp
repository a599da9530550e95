#include "keys/SubjectName.h"

#include <gmock/gmock.h>

#include <algorithm>

#include "keys/Certificates.h"

namespace Rabit::Keys
{
namespace
{

std::array<std::uint8_t, 12> PrefixFor(const SubjectName &subject)
{
    std::array<std::uint8_t, 12> prefix{};
    const auto start = GuidStartOf(*subject.Encoded());
    std::copy(start.begin(), start.end(), prefix.begin());
    return prefix;
}

TEST(SubjectName, IsFoundAgainInACertificate)
{
    const SubjectName subject{.Fleet = "blue", .Number = 17, .Node = "uav1.vision"};
    const KeyPtr key = MakeKey();
    const CertificatePtr authority = MakeAuthority("blue", "identity authority", *key, {0, 1000});
    EXPECT_EQ(SubjectOf(*MakeCertificate(subject, *key, {0, 1000}, *authority, *key)), subject);
}

TEST(SubjectName, OfAnAuthorityIsNoNodes)
{
    const KeyPtr key = MakeKey();
    EXPECT_THROW(SubjectOf(*MakeAuthority("blue", "identity authority", *key, {0, 1000})), KeysError);
}

TEST(SubjectName, GuidsBeginWithAOneAndThenAsTheHash)
{
    const auto start = GuidStartOf(*SubjectName{.Fleet = "blue", .Number = 0, .Node = "uav1"}.Encoded());
    EXPECT_EQ(start[0] & 0x80, 0x80);
}

TEST(SubjectName, SomeNumberMakesASmallGuidAndSomeALargeOne)
{
    for (const std::string node : {"uav1", "uav2", "ground", "x"})
    {
        int small = 0;
        for (unsigned number = 0; number <= SubjectName::LargestNumber; ++number)
        {
            small += HasSmallGuid({.Fleet = "blue", .Number = number, .Node = node}) ? 1 : 0;
        }
        EXPECT_GT(small, 50) << node;
        EXPECT_LT(small, 200) << node;
    }
}

TEST(SubjectName, AGuidIsOfItsNodeWithWhateverNumberAndOfNoOther)
{
    for (const unsigned number : {0U, 1U, SubjectName::LargestNumber})
    {
        const auto prefix = PrefixFor({.Fleet = "blue", .Number = number, .Node = "uav1"});
        EXPECT_TRUE(IsGuidOf("blue", "uav1", prefix)) << number;
        EXPECT_FALSE(IsGuidOf("blue", "uav2", prefix)) << number;
        EXPECT_FALSE(IsGuidOf("red", "uav1", prefix)) << number;
    }
}

TEST(SubjectName, HostileNamesAreNobodys)
{
    const std::array<std::uint8_t, 12> prefix{};
    EXPECT_FALSE(IsGuidOf("blue", "", prefix));
    EXPECT_FALSE(IsGuidOf("blue", std::string(100000, 'x'), prefix));
    EXPECT_FALSE(IsGuidOf("blue", std::string("a\0b", 3), prefix));
}

}  // namespace
}  // namespace Rabit::Keys
