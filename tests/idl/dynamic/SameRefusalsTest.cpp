// A type made at run time refuses the bytes that generated code refuses, and no others.
#include "CorpusTest.h"
#include "RandomSample.h"

namespace
{

// A copy whose end is the end of an allocation, so that AddressSanitizer sees a read past it.
Bytes Exactly(const Bytes &bytes, std::size_t size)
{
    Bytes copy;
    copy.reserve(size);
    copy.assign(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    return copy;
}

// Expects that all ways to read a sample agree on whether it is valid, and on its value.
void ExpectAlike(const Rabit::MessageType &generated, const Rabit::DynamicType &dynamic, const Bytes &sample)
{
    const auto message = generated.Create();
    const bool isSample = generated.Deserialize(sample, *message);
    const auto normal = dynamic.Normalized(sample);
    ASSERT_EQ(normal.has_value(), isSample);
    ASSERT_EQ(dynamic.ToJson(sample).has_value(), isSample);
    ASSERT_EQ(dynamic.ToText(sample).has_value(), isSample);
    std::array<std::uint8_t, 16> hash{};
    ASSERT_EQ(dynamic.KeyHashOf(sample, hash), isSample && dynamic.HasKey());
    if (isSample)
    {
        ASSERT_EQ(*normal, SampleOf(generated, *message));
    }
}

TEST_EACH_TYPE(SameRefusals, OfASampleCutAnywhere)
{
    const auto shapes = ShapesOf(generated);
    std::mt19937 random(5U);
    for (int round = 0; round < 6; ++round)
    {
        const Bytes sample = RandomSample(*shapes->Root, round % 2 == 0, random);
        const std::size_t step = 1 + sample.size() / 300;
        for (std::size_t size = 0; size <= sample.size(); size += step)
        {
            ASSERT_NO_FATAL_FAILURE(ExpectAlike(generated, dynamic, Exactly(sample, size)))
                << size << " of " << sample.size();
        }
        for (std::size_t size = sample.size() - std::min<std::size_t>(8, sample.size()); size < sample.size();
             ++size)
        {
            ASSERT_NO_FATAL_FAILURE(ExpectAlike(generated, dynamic, Exactly(sample, size)))
                << size << " of " << sample.size();
        }
    }
}

TEST_EACH_TYPE(SameRefusals, OfMoreThanPaddingBehindASample)
{
    Bytes sample = dynamic.DefaultSample();
    for (int more = 0; more < 6; ++more)
    {
        sample.push_back(0);
        ASSERT_NO_FATAL_FAILURE(ExpectAlike(generated, dynamic, sample)) << more;
    }
}

TEST_EACH_TYPE(SameRefusals, OfOtherEncodings)
{
    Bytes sample = dynamic.DefaultSample();
    for (unsigned identifier = 0; identifier < 0x10000; identifier += identifier < 64 ? 1 : 251)
    {
        sample[0] = static_cast<std::uint8_t>(identifier >> 8);
        sample[1] = static_cast<std::uint8_t>(identifier);
        ASSERT_NO_FATAL_FAILURE(ExpectAlike(generated, dynamic, sample)) << identifier;
    }
}

// A changed byte may meet bounds, enumerators, booleans, bits, terminators or discriminators.
TEST_EACH_TYPE(SameRefusals, OfGarbledSamples)
{
    static constexpr std::uint8_t nasty[] = {0x00, 0x01, 0x02, 0x7f, 0x80, 0xff};
    const auto shapes = ShapesOf(generated);
    std::mt19937 random(6U);
    const auto below = [&](std::size_t limit) { return random() % limit; };
    for (int round = 0; round < RoundsFor(dynamic, 1000); ++round)
    {
        Bytes sample = RandomSample(*shapes->Root, round % 2 == 0, random);
        for (std::size_t i = 1 + below(4); i > 0; --i)
        {
            sample[1 + below(sample.size() - 1)] =
                below(2) == 0 ? static_cast<std::uint8_t>(random()) : nasty[below(sizeof nasty)];
        }
        ASSERT_NO_FATAL_FAILURE(ExpectAlike(generated, dynamic, Exactly(sample, sample.size())))
            << "round " << round;
    }
}

}  // namespace
