#include "wire/TypeFrames.h"

#include <gtest/gtest.h>
#include <rabit/gateway/links/LinkMessages.h>

#include <random>
#include <string>

#include "wire/LinkSampleCodec.h"

namespace Rabit
{
namespace
{

std::vector<std::uint8_t> FrameOf(std::uint32_t first, std::uint32_t of, std::size_t size)
{
    const std::vector<std::uint8_t> bytes(size, 7);
    return TypeFrames::Encode({.Definition = 0x0102030405060708, .First = first, .Of = of, .Bytes = bytes});
}

TEST(TypeFrames, WhatIsEncodedIsWhatIsDecoded)
{
    const auto frame = FrameOf(1000, 1005, 5);
    const auto part = TypeFrames::Decode(frame);
    ASSERT_TRUE(part.has_value());
    EXPECT_EQ(part->Definition, 0x0102030405060708u);
    EXPECT_EQ(part->First, 1000u);
    EXPECT_EQ(part->Of, 1005u);
    EXPECT_EQ(std::vector<std::uint8_t>(part->Bytes.begin(), part->Bytes.end()),
              std::vector<std::uint8_t>(5, 7));
}

TEST(TypeFrames, AreNoFramesOfTheLinks)
{
    EXPECT_EQ(FrameOf(0, 1, 1).front(), TypeFrames::FirstByte);
    EXPECT_NE(TypeFrames::FirstByte, LinkVersion);
}

TEST(TypeFrames, WhatLiesOutsideOfTheWholeOrIsTooLargeIsNone)
{
    EXPECT_TRUE(TypeFrames::Decode(FrameOf(0, TypeFrames::LargestText, 10)).has_value());
    EXPECT_FALSE(TypeFrames::Decode(FrameOf(0, TypeFrames::LargestText + 1, 10)).has_value());
    EXPECT_FALSE(TypeFrames::Decode(FrameOf(1, 10, 10)).has_value());
    EXPECT_FALSE(TypeFrames::Decode(FrameOf(0xffffffff, 10, 10)).has_value());
    EXPECT_FALSE(TypeFrames::Decode(FrameOf(10, 10, 1)).has_value());
    EXPECT_FALSE(TypeFrames::Decode(FrameOf(0, 10, 0)).has_value());
}

TEST(TypeFrames, NoBytesEndTheProcess)
{
    std::mt19937 random(1);
    const auto good = FrameOf(10, 100, 20);
    int taken = 0;
    for (int i = 0; i < 20000; ++i)
    {
        std::vector<std::uint8_t> bad = good;
        bad.resize(random() % (good.size() + 10));
        for (int edit = 0; edit < 3 && !bad.empty(); ++edit)
        {
            bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
        }
        const auto part = TypeFrames::Decode(bad);
        if (part)
        {
            ++taken;
            EXPECT_LE(part->First + part->Bytes.size(), part->Of);
            EXPECT_LE(part->Of, TypeFrames::LargestText);
        }
    }
    EXPECT_GT(taken, 0);
}

TEST(TypeFrames, TravelInSamplesOfTheLinksTopic)
{
    for (std::size_t size = 1; size < 10; ++size)
    {
        const auto frame = FrameOf(0, 100, size);
        const FrameBytesEncoder encoder(frame);
        std::vector<std::uint8_t> sample(encoder.EncodedSize());
        ASSERT_TRUE(encoder.Encode(sample));
        std::span<const std::uint8_t> opened;
        ASSERT_TRUE(OpenLinkSample(sample, opened));
        EXPECT_EQ(std::vector<std::uint8_t>(opened.begin(), opened.end()), frame);
    }
}

}  // namespace
}  // namespace Rabit
