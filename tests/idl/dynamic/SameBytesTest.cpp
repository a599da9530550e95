// A type made at run time encodes and decodes like the code generated from the same IDL.
#include "CorpusTest.h"
#include "RandomSample.h"

namespace
{

TEST_EACH_TYPE(SameBytes, NewMessagesAreAlike)
{
    EXPECT_EQ(dynamic.DefaultSample(), SampleOf(generated, *generated.Create()));
    EXPECT_EQ(SampleOf(dynamic, *dynamic.Create()), SampleOf(generated, *generated.Create()));
}

TEST_EACH_TYPE(SameBytes, EverySampleOfEitherByteOrderIsReadAlike)
{
    const auto shapes = ShapesOf(generated);
    std::mt19937 random(1U);
    for (int round = 0; round < RoundsFor(dynamic, 200); ++round)
    {
        const Bytes sample = RandomSample(*shapes->Root, round % 2 == 0, random);
        const Bytes expected = ByGeneratedCode(generated, sample);
        ASSERT_FALSE(expected.empty()) << "round " << round;
        ASSERT_EQ(dynamic.Normalized(sample), expected) << "round " << round;
    }
}

TEST_EACH_TYPE(SameBytes, ComeBackFromJson)
{
    const auto shapes = ShapesOf(generated);
    std::mt19937 random(2U);
    for (int round = 0; round < RoundsFor(dynamic, 200); ++round)
    {
        const Bytes sample = RandomSample(*shapes->Root, round % 2 == 0, random);
        const auto json = dynamic.ToJson(sample);
        ASSERT_TRUE(json) << "round " << round;
        const Rabit::EncodedSample encoded = dynamic.FromJson(*json);
        ASSERT_TRUE(encoded.Sample) << "round " << round << ": " << encoded.Reason << "\n" << *json;
        ASSERT_EQ(*encoded.Sample, ByGeneratedCode(generated, sample)) << "round " << round << "\n" << *json;
    }
}

TEST_EACH_TYPE(SameBytes, GiveTheSameText)
{
    const auto shapes = ShapesOf(generated);
    std::mt19937 random(3U);
    const auto message = generated.Create();
    for (int round = 0; round < RoundsFor(dynamic, 200); ++round)
    {
        const Bytes sample = RandomSample(*shapes->Root, round % 2 == 0, random);
        ASSERT_TRUE(generated.Deserialize(sample, *message)) << "round " << round;
        ASSERT_EQ(dynamic.ToText(sample), message->ToString()) << "round " << round;
    }
}

TEST_EACH_TYPE(SameBytes, GiveTheSameKeyHash)
{
    ASSERT_EQ(dynamic.HasKey(), generated.HasKey());
    const auto shapes = ShapesOf(generated);
    std::mt19937 random(4U);
    for (int round = 0; round < RoundsFor(dynamic, 200); ++round)
    {
        const Bytes sample = RandomSample(*shapes->Root, round % 2 == 0, random);
        std::array<std::uint8_t, 16> expected{};
        std::array<std::uint8_t, 16> hash{};
        ASSERT_EQ(generated.KeyHashOf(sample, expected), dynamic.KeyHashOf(sample, hash))
            << "round " << round;
        ASSERT_EQ(hash, expected) << "round " << round;
    }
}

TEST_EACH_TYPE(SameBytes, ItsOwnTextIsThatOfTheGeneratedType)
{
    EXPECT_EQ(dynamic.IdlText(), generated.IdlText());
    EXPECT_EQ(dynamic.Name(), generated.Name());
}

}  // namespace
