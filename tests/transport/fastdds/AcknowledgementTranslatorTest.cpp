#include "AcknowledgementTranslator.h"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace
{

using Rabit::FastDds::AcknowledgementTranslator;
using Bytes = std::vector<std::uint8_t>;

constexpr std::uint8_t AckNackKind = 0x06;
constexpr std::uint8_t NackFragKind = 0x12;

void Append(Bytes &to, const Bytes &bytes)
{
    to.insert(to.end(), bytes.begin(), bytes.end());
}

void AppendU32(Bytes &to, std::uint32_t value, bool littleEndian = true)
{
    for (int i = 0; i < 4; ++i)
    {
        to.push_back(static_cast<std::uint8_t>(value >> 8 * (littleEndian ? i : 3 - i)));
    }
}

struct Acknowledgement
{
    std::uint8_t Sender = 1;
    std::uint8_t Reader = 7;
    std::uint32_t Base = 1;
    std::uint32_t Bits = 0;
    bool Final = true;
    std::uint32_t Count = 0;
    bool LittleEndian = true;
    std::uint8_t Kind = AckNackKind;
};

void AppendTo(Bytes &message, const Acknowledgement &said)
{
    Bytes body = {0, 0, 4, said.Reader, 0, 0, 4, 0xc2};
    AppendU32(body, 0, said.LittleEndian);
    AppendU32(body, said.Base, said.LittleEndian);
    if (said.Kind == NackFragKind)
    {
        AppendU32(body, 1, said.LittleEndian);  // the first fragment of the set
    }
    AppendU32(body, said.Bits, said.LittleEndian);
    for (std::uint32_t i = 0; i < said.Bits; i += 32)
    {
        AppendU32(body, 0xffffffff, said.LittleEndian);
    }
    AppendU32(body, said.Count, said.LittleEndian);
    const auto size = static_cast<std::uint8_t>(body.size());
    const auto flags = static_cast<std::uint8_t>((said.LittleEndian ? 1 : 0) | (said.Final ? 2 : 0));
    Append(message, {said.Kind, flags, said.LittleEndian ? size : std::uint8_t{0},
                     said.LittleEndian ? std::uint8_t{0} : size});
    Append(message, body);
}

Bytes Header(std::uint8_t sender)
{
    return {'R', 'T', 'P', 'S', 2, 1, 1, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, sender};
}

// Returns the datagram with this acknowledgement after translation.
Bytes Rewritten(AcknowledgementTranslator &translator, const Acknowledgement &said)
{
    Bytes datagram = Header(said.Sender);
    AppendTo(datagram, said);
    translator.Translate(datagram);
    return datagram;
}

// Returns the count after translation: the last bytes of the datagram.
std::uint32_t CountAfter(AcknowledgementTranslator &translator, const Acknowledgement &said)
{
    const Bytes datagram = Rewritten(translator, said);
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < 4; ++i)
    {
        count = count << 8 | datagram[datagram.size() - (said.LittleEndian ? i + 1 : 4 - i)];
    }
    return count;
}

constexpr Acknowledgement HasSeven{.Base = 8, .Count = 2};
constexpr Acknowledgement HasNothing{.Final = false, .Count = 0};

TEST(AcknowledgementTranslator, CountsRiseWithTheSenders)
{
    AcknowledgementTranslator translator;
    const auto first = CountAfter(translator, {.Base = 2, .Count = 1});
    EXPECT_GT(first, 0u);  // the vendor begins at 0
    const auto second = CountAfter(translator, {.Base = 3, .Count = 2});
    EXPECT_GT(second, first);
    EXPECT_GT(CountAfter(translator, {.Base = 3, .Bits = 40, .Count = 900}), second);
}

TEST(AcknowledgementTranslator, RepeatsAndStragglersAreNoNews)
{
    AcknowledgementTranslator translator;
    CountAfter(translator, {.Base = 2, .Count = 1});
    const auto newest = CountAfter(translator, {.Base = 3, .Count = 2});
    EXPECT_LE(CountAfter(translator, {.Base = 3, .Count = 2}), newest);
    EXPECT_LE(CountAfter(translator, {.Base = 2, .Count = 1}), newest);
}

// Untranslated, one forged acknowledgement with the highest count would silence all honest ones after it.
TEST(AcknowledgementTranslator, AForgedCountDoesNotSilenceTheHonestOnes)
{
    AcknowledgementTranslator translator;
    CountAfter(translator, {.Base = 2, .Count = 1});
    const auto forged = CountAfter(translator, {.Base = 2, .Count = 0xffffffff});
    EXPECT_GT(CountAfter(translator, {.Base = 3, .Count = 2}), forged);
}

TEST(AcknowledgementTranslator, AReaderThatBeginsAnewIsNews)
{
    AcknowledgementTranslator translator;
    const auto before = CountAfter(translator, HasSeven);
    EXPECT_GT(CountAfter(translator, HasNothing), before);
}

TEST(AcknowledgementTranslator, CountsGoOnFromWhereAReaderBeganAnew)
{
    AcknowledgementTranslator translator;
    CountAfter(translator, HasSeven);
    const auto begun = CountAfter(translator, HasNothing);
    EXPECT_LE(CountAfter(translator, HasNothing), begun) << "a repeat";
    EXPECT_GT(CountAfter(translator, {.Bits = 7, .Count = 1}), begun);
}

// Cyclone DDS puts messages of several participants of a process into one datagram.
TEST(AcknowledgementTranslator, WhoIsSpokenForIsToldFromWhoSends)
{
    AcknowledgementTranslator translator;
    CountAfter(translator, {.Sender = 1, .Base = 2, .Count = 6});
    const auto ofOne = CountAfter(translator, {.Sender = 1, .Base = 2, .Count = 7});
    Bytes datagram = Header(2);
    AppendTo(datagram, {.Base = 2, .Count = 20});
    Append(datagram, {0x0c, 1, 20, 0, 0, 0, 0, 0, 2, 1, 1, 16, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1});
    AppendTo(datagram, {.Base = 2, .Count = 7});
    translator.Translate(datagram);
    EXPECT_EQ(datagram[datagram.size() - 4], ofOne) << "a repeat";
}

TEST(AcknowledgementTranslator, AReaderThatHadNothingYetOnlyRepeatsItself)
{
    AcknowledgementTranslator translator;
    const auto first = CountAfter(translator, HasNothing);
    EXPECT_EQ(CountAfter(translator, HasNothing), first);
}

TEST(AcknowledgementTranslator, AnAnswerThatNothingIsThereIsNoBeginning)
{
    AcknowledgementTranslator translator;
    const auto before = CountAfter(translator, HasSeven);
    EXPECT_LE(CountAfter(translator, {.Base = 1, .Final = true, .Count = 1}), before);
}

TEST(AcknowledgementTranslator, AllReadersOfAParticipantBeginAnewTogether)
{
    AcknowledgementTranslator translator;
    CountAfter(translator, HasSeven);
    auto other = HasSeven;
    other.Reader = 9;
    const auto before = CountAfter(translator, other);
    CountAfter(translator, HasNothing);
    auto asking = HasNothing;
    asking.Reader = 9;
    EXPECT_GT(CountAfter(translator, asking), before);
}

TEST(AcknowledgementTranslator, ARequestForAllSaysItAsTheVendorDoes)
{
    for (const bool littleEndian : {true, false})
    {
        AcknowledgementTranslator translator;
        auto asking = HasNothing;
        asking.LittleEndian = littleEndian;
        Bytes expected = Header(1);
        asking.Base = 0;
        asking.Count = 1;
        AppendTo(expected, asking);
        asking.Base = 1;
        EXPECT_EQ(Rewritten(translator, asking), expected);
    }
}

TEST(AcknowledgementTranslator, WhatElseIsSaidStays)
{
    AcknowledgementTranslator translator;
    for (Acknowledgement said :
         {Acknowledgement{.Base = 8, .Bits = 70, .Final = false, .Count = 1},
          Acknowledgement{.Reader = 8, .Base = 1, .Bits = 7, .Final = false, .Count = 1},
          Acknowledgement{.Reader = 9, .Base = 1, .Count = 1},
          Acknowledgement{.Base = 1, .Bits = 2, .Count = 1, .Kind = NackFragKind}})
    {
        Bytes expected = Header(1);
        AppendTo(expected, said);
        EXPECT_EQ(Rewritten(translator, said), expected);
    }
}

TEST(AcknowledgementTranslator, RequestsForFragmentsBeginAnewWithTheirParticipant)
{
    AcknowledgementTranslator translator;
    const Acknowledgement fragments{.Reader = 4, .Base = 5, .Bits = 3, .Count = 300, .Kind = NackFragKind};
    CountAfter(translator, HasSeven);
    const auto before = CountAfter(translator, fragments);
    CountAfter(translator, HasNothing);
    auto anew = fragments;
    anew.Count = 1;
    EXPECT_GT(CountAfter(translator, anew), before);
}

TEST(AcknowledgementTranslator, TheCountsOfOthersGoOn)
{
    AcknowledgementTranslator translator;
    auto other = HasSeven;
    other.Sender = 2;
    CountAfter(translator, HasSeven);
    const auto before = CountAfter(translator, other);
    CountAfter(translator, HasNothing);
    EXPECT_EQ(CountAfter(translator, other), before);
}

TEST(AcknowledgementTranslator, WritesInTheSendersByteOrder)
{
    AcknowledgementTranslator translator;
    auto big = HasSeven;
    big.LittleEndian = false;
    const auto before = CountAfter(translator, big);
    EXPECT_LT(before, 1000u);
    big.Count = 256;
    EXPECT_EQ(CountAfter(translator, big), before + 1);
}

TEST(AcknowledgementTranslator, TranslatesAllSubmessagesOfADatagram)
{
    AcknowledgementTranslator translator;
    Bytes datagram = Header(1);
    Append(datagram, {0x09, 3, 0, 0});  // a time stamp that has none
    AppendTo(datagram, {.Reader = 7, .Base = 8, .Count = 41});
    AppendTo(datagram, {.Reader = 8, .Base = 8, .Count = 42});
    translator.Translate(datagram);
    Bytes expected = Header(1);
    Append(expected, {0x09, 3, 0, 0});
    AppendTo(expected, {.Reader = 7, .Base = 8, .Count = 1});
    AppendTo(expected, {.Reader = 8, .Base = 8, .Count = 1});
    EXPECT_EQ(datagram, expected);
}

TEST(AcknowledgementTranslator, IsBoundedAndCountsRiseAllTheSame)
{
    AcknowledgementTranslator translator;
    const auto before = CountAfter(translator, HasSeven);
    for (std::size_t i = 0; i < AcknowledgementTranslator::MostExchanges + 10; ++i)
    {
        Bytes datagram = Header(9);
        datagram[8] = static_cast<std::uint8_t>(i);
        datagram[9] = static_cast<std::uint8_t>(i >> 8);
        AppendTo(datagram, HasSeven);
        translator.Translate(datagram);
    }
    EXPECT_LE(translator.Exchanges(), AcknowledgementTranslator::MostExchanges);
    EXPECT_GT(CountAfter(translator, HasSeven), before);
}

}  // namespace
