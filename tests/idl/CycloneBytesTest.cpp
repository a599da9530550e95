// The bytes are those of another DDS: Cyclone DDS's encoder for the C types of the same IDL files.
#include "Samples.h"

extern "C"
{
#include "CycloneValues.h"
}
// Cyclone DDS copies a string constant without its backslashes, and clang warns although the macro is
// unused.
#ifdef __clang__
#pragma clang diagnostic push
#pragma clang diagnostic ignored "-Wreserved-user-defined-literal"
#endif
#include "constructs.h"
#ifdef __clang__
#pragma clang diagnostic pop
#endif
#include "keys.h"

#include <rabit/idl/MessageType.h>
#include <rabit/idl/MessageTypeRegistry.h>

#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <random>

namespace
{

const dds_topic_descriptor_t *DescriptorOf(const Rabit::RabitMessage &message)
{
    static const std::map<std::string, const dds_topic_descriptor_t *> all{
        {"Constructs::Numbers", &Constructs_Numbers_desc},
        {"Constructs::Defaults", &Constructs_Defaults_desc},
        {"Constructs::Texts", &Constructs_Texts_desc},
        {"Constructs::Choices", &Constructs_Choices_desc},
        {"Constructs::Collections", &Constructs_Collections_desc},
        {"Constructs::Unions", &Constructs_Unions_desc},
        {"Constructs::Derived", &Constructs_Derived_desc},
        {"Constructs::Upper", &Constructs_Upper_desc},
        {"Constructs::Inner::Empty", &Constructs_Inner_Empty_desc},
        {"Constructs::Keywords", &Constructs_Keywords_desc},
        {"Global", &Global_desc},
        {"Keys::ShortKey", &Keys_ShortKey_desc},
        {"Keys::ExactKey", &Keys_ExactKey_desc},
        {"Keys::LongKey", &Keys_LongKey_desc},
        {"Keys::TextKey", &Keys_TextKey_desc},
        {"Keys::BoundedTextKey", &Keys_BoundedTextKey_desc},
        {"Keys::WideBoundedTextKey", &Keys_WideBoundedTextKey_desc},
        {"Keys::NestedKey", &Keys_NestedKey_desc},
        {"Keys::ArrayKey", &Keys_ArrayKey_desc},
        {"Keys::NumberedKey", &Keys_NumberedKey_desc},
        {"Keys::DerivedKey", &Keys_DerivedKey_desc}};
    const auto found = all.find(Rabit::MessageTypeRegistry::Of(message)->Name());
    return found == all.end() ? nullptr : found->second;
}

std::vector<std::uint8_t> Bytes(const CycloneBytes &result)
{
    return {result.bytes, result.bytes + result.size};
}

std::vector<std::uint8_t> DecodedAndEncodedByCyclone(const Rabit::RabitMessage &message,
                                                     const std::vector<std::uint8_t> &bytes)
{
    const auto result = std::make_unique<CycloneBytes>();
    CycloneDecodeAndEncode(DescriptorOf(message), bytes.data(), bytes.size(), result.get());
    return Bytes(*result);
}

// Samples whose values CycloneValues.c repeats in C.
std::vector<Sample> SamplesWithCValue()
{
    std::vector<Sample> samples = AllSamples();
    std::erase_if(
        samples, [](const Sample &sample) { return CycloneValueNamed(sample.Name.c_str()).type == nullptr; });
    return samples;
}

// Samples whose types were generated in C, too.
std::vector<Sample> SamplesWithCType()
{
    std::vector<Sample> samples = AllSamples();
    std::erase_if(samples, [](const Sample &sample) { return DescriptorOf(*sample.Message) == nullptr; });
    return samples;
}

TEST(CycloneBytes, EqualValuesGiveEqualBytes)
{
    ASSERT_EQ(SamplesWithCValue().size(), 17U);
    for (const Sample &sample : SamplesWithCValue())
    {
        const CycloneValue value = CycloneValueNamed(sample.Name.c_str());
        const auto result = std::make_unique<CycloneBytes>();
        CycloneEncode(value.type, value.value, result.get());
        EXPECT_EQ(BytesOf(*sample.Message), Bytes(*result)) << sample.Name;
    }
}

TEST(CycloneBytes, CycloneReadsOurBytesAndWritesTheSame)
{
    ASSERT_EQ(SamplesWithCType().size(), 30U);
    for (const Sample &sample : SamplesWithCType())
    {
        const std::vector<std::uint8_t> bytes = BytesOf(*sample.Message);
        EXPECT_EQ(bytes, DecodedAndEncodedByCyclone(*sample.Message, bytes)) << sample.Name;
    }
}

TEST(CycloneBytes, BigEndianBytesOfCycloneDecode)
{
    for (const Sample &sample : SamplesWithCValue())
    {
        const CycloneValue value = CycloneValueNamed(sample.Name.c_str());
        const auto result = std::make_unique<CycloneBytes>();
        CycloneEncodeBigEndian(value.type, value.value, result.get());
        ASSERT_NE(result->size, 0U) << sample.Name;
        const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(*sample.Message);
        const auto decoded = type->Create();
        ASSERT_TRUE(type->Deserialize(Bytes(*result), *decoded)) << sample.Name;
        EXPECT_EQ(BytesOf(*decoded), BytesOf(*sample.Message)) << sample.Name;
    }
}

// The specification decides by the largest key of the type, Cyclone DDS by the key at hand unless told
// otherwise.
bool KeyMayBeLong(const std::string &type)
{
    return type == "Keys::LongKey" || type == "Keys::TextKey" || type == "Keys::WideBoundedTextKey";
}

TEST(CycloneBytes, KeyHashesAreThoseOfCyclone)
{
    int compared = 0;
    for (const Sample &sample : SamplesWithCType())
    {
        const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(*sample.Message);
        if (!type->HasKey())
        {
            continue;
        }
        ++compared;
        const std::vector<std::uint8_t> bytes = BytesOf(*sample.Message);
        const auto result = std::make_unique<CycloneBytes>();
        CycloneDecodeAndEncode(DescriptorOf(*sample.Message), bytes.data(), bytes.size(), result.get());
        ASSERT_NE(result->size, 0U) << sample.Name;
        std::array<std::uint8_t, 16> hash{};
        ASSERT_TRUE(type->KeyHashOf(bytes, hash)) << sample.Name;
        const std::uint8_t *expected = KeyMayBeLong(type->Name()) ? result->keyHashMd5 : result->keyHash;
        EXPECT_EQ(std::vector<std::uint8_t>(hash.begin(), hash.end()),
                  std::vector<std::uint8_t>(expected, expected + hash.size()))
            << sample.Name;
    }
    EXPECT_EQ(compared, 11);
}

// Cyclone DDS accepts each garbled sample that we accept, and decodes it to the same value: we are not
// laxer.
TEST(CycloneBytes, CycloneAcceptsGarbledBytesThatWeAccept)
{
    int accepted = 0;
    std::mt19937 random(99U);
    for (const Sample &sample : SamplesWithCType())
    {
        const Rabit::MessageType *type = Rabit::MessageTypeRegistry::Of(*sample.Message);
        const std::vector<std::uint8_t> bytes = BytesOf(*sample.Message);
        const auto target = type->Create();
        for (int round = 0; round < 100; ++round)
        {
            std::vector<std::uint8_t> garbled = bytes;
            garbled[4 + random() % (garbled.size() - 4)] = static_cast<std::uint8_t>(random());
            if (round % 5 == 0 && type->Deserialize(garbled, *target))
            {
                ++accepted;
                ASSERT_EQ(BytesOf(*target), DecodedAndEncodedByCyclone(*sample.Message, garbled))
                    << sample.Name;
            }
        }
    }
    EXPECT_GT(accepted, 100);
}

}  // namespace
