// How lists of permissions and bulletins travel in parts.
#include "envelope/BlobExchange.h"

#include <gtest/gtest.h>

#include <array>
#include <chrono>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "envelope/KeyDerivation.h"

namespace
{

using namespace std::chrono_literals;
using namespace Rabit::Envelope;
using Bytes = std::vector<std::uint8_t>;

constexpr RtpsHeader BlobHeader{'R', 'T', 'P', 'S', 2, 2, 'R', 'b', 1};

Bytes ContentOf(std::size_t size)
{
    Bytes content(size);
    for (std::size_t i = 0; i < size; ++i)
    {
        content[i] = static_cast<std::uint8_t>(i * i + i / 251);
    }
    return content;
}

TEST(BlobMessages, AreTheSameAfterWritingAndReading)
{
    const Bytes content = ContentOf(2500);
    BlobMessage message;
    message.Requests = {{.Of = 7, .Wanted = {1, 2, 3}, .Parts = ~std::uint64_t{0}},
                        {.Of = 8, .Wanted = {4}, .Parts = 5}};
    message.Part = BlobPart{.Kind = BlobKind::Bulletin,
                            .Index = 2,
                            .Size = content.size(),
                            .Of = Sha256(content),
                            .Bytes = std::span(content).subspan(2 * BlobPartSize)};
    const Bytes written = WriteBlobMessage(BlobHeader, message);
    EXPECT_EQ(written.size() % 4, 0u);
    const auto read = ReadBlobMessage(written);
    ASSERT_TRUE(read && read->Part);
    EXPECT_EQ(read->Requests, message.Requests);
    EXPECT_EQ(read->Part->Kind, BlobKind::Bulletin);
    EXPECT_EQ(read->Part->Index, 2u);
    EXPECT_EQ(read->Part->Size, content.size());
    EXPECT_EQ(read->Part->Of, Sha256(content));
    EXPECT_EQ(Bytes(read->Part->Bytes.begin(), read->Part->Bytes.end()),
              Bytes(content.begin() + 2 * BlobPartSize, content.end()));
}

TEST(BlobMessages, ThatAreCutOffAreNone)
{
    const Bytes content = ContentOf(300);
    BlobMessage message;
    message.Requests = {{.Of = 7, .Wanted = {1}, .Parts = 1}};
    message.Part = BlobPart{.Size = content.size(), .Of = Sha256(content), .Bytes = content};
    const Bytes written = WriteBlobMessage(BlobHeader, message);
    for (std::size_t size = 0; size < written.size(); ++size)
    {
        EXPECT_FALSE(ReadBlobMessage(std::span(written).first(size)).has_value()) << size;
    }
}

TEST(BlobMessages, WithAnyByteChangedHaveNoPartOutsideOfTheirBounds)
{
    const Bytes content = ContentOf(300);
    BlobMessage message;
    message.Part = BlobPart{.Size = content.size(), .Of = Sha256(content), .Bytes = content};
    const Bytes written = WriteBlobMessage(BlobHeader, message);
    for (std::size_t at = 0; at < written.size(); ++at)
    {
        for (const int change : {1, 0x80, 0xff})
        {
            Bytes changed = written;
            changed[at] = static_cast<std::uint8_t>(changed[at] ^ change);
            if (const auto read = ReadBlobMessage(changed); read && read->Part)
            {
                EXPECT_LE(read->Part->Size, LargestBlob);
                EXPECT_LT(read->Part->Index, BlobPartsOf(read->Part->Size));
            }
        }
    }
}

// Three sessions of the tags 1 to 3. The first one has a blob.
class BlobExchanges : public testing::Test
{
protected:
    explicit BlobExchanges(std::size_t size = 5000) : Content(ContentOf(size)), Of(Sha256(Content))
    {
        A.SetOwn(BlobKind::Permissions, Of, std::make_shared<const Bytes>(Content));
    }
    // Runs in steps of a millisecond. `isLost`: for each datagram at each receiver. Expects that DueBytes
    // said what goes out, without padding.
    template <typename IsLost>
    void Run(std::chrono::milliseconds time, const IsLost &isLost)
    {
        for (const TimePoint end = Now + time; Now < end; Now += 1ms)
        {
            for (std::size_t from = 0; from < 3; ++from)
            {
                const std::size_t said = All[from]->DueBytes(Now);
                const auto sent = All[from]->TakeDue(Now);
                EXPECT_EQ((said + 3) / 4 * 4, sent ? sent->Message.size() : 0u);
                const auto message = sent ? ReadBlobMessage(sent->Message) : std::nullopt;
                for (std::size_t to = 0; message && to < 3; ++to)
                {
                    if (to == from || isLost())
                    {
                        continue;
                    }
                    const BlobExchange::Source source{.Tag = static_cast<SessionTag>(from + 1),
                                                      .In = sent->In};
                    if (auto blob = All[to]->Received(*message, source, AreProven, Now))
                    {
                        Came.emplace(to, std::move(blob->Bytes));
                    }
                }
                Messages += message ? 1 : 0;
            }
        }
    }
    void Run(std::chrono::milliseconds time)
    {
        Run(time, [] { return false; });
    }

    const Bytes Content;
    const Hash Of;
    TimePoint Now{1h};
    BlobExchange A{1, BlobHeader, 0};
    BlobExchange B{2, BlobHeader, 128};
    BlobExchange C{3, BlobHeader, 255};
    std::array<BlobExchange *, 3> All{&A, &B, &C};
    std::multimap<std::size_t, Bytes> Came;
    std::size_t Messages = 0;
    bool AreProven = true;
};

TEST_F(BlobExchanges, BringABlobInParts)
{
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(500ms);
    ASSERT_EQ(Came.count(1), 1u);
    EXPECT_EQ(Came.find(1)->second, Content);
    EXPECT_FALSE(B.IsWanted(Of));
    EXPECT_EQ(B.Incomplete(), 0u);
    // One request, five parts.
    EXPECT_EQ(Messages, 6u);
    Run(60s);
    EXPECT_EQ(Messages, 6u);
}

TEST_F(BlobExchanges, AnswerSeveralByTheSameParts)
{
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    C.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(500ms);
    EXPECT_EQ(Came.size(), 2u);
    EXPECT_LE(Messages, 8u);
}

TEST_F(BlobExchanges, BringItWhereEveryThirdDatagramIsLost)
{
    int count = 0;
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(5s, [&count] { return ++count % 3 == 0; });
    EXPECT_EQ(Came.count(1), 1u);
}

TEST_F(BlobExchanges, SendAStrangerNoMoreThanCameFromIt)
{
    AreProven = false;
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(5s);
    EXPECT_TRUE(Came.empty());
    A.Credit(1500);
    Messages = 0;
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(5s);
    // One part of five.
    EXPECT_TRUE(Came.empty());
    EXPECT_EQ(B.Incomplete(), BlobPartSize);
}

// It says that the blob is as large as one can be, and sends each part just before it would be given up.
TEST_F(BlobExchanges, AMemberThatSendsWrongPartsSlowlyKeepsABlobBackForSecondsAlone)
{
    const Bytes wrong(BlobPartSize, 0);
    const TimePoint begin = Now;
    std::size_t index = 0;
    while (Came.empty() && Now - begin < 60s)
    {
        // Its sessions take turns.
        const BlobExchange::Source liar{.Tag = static_cast<SessionTag>(30 + index % 3), .In = 4, .Number = 3};
        B.Want(BlobKind::Permissions, Of, liar, Now);
        BlobMessage lie;
        lie.Part = BlobPart{
            .Kind = BlobKind::Permissions, .Index = index, .Size = LargestBlob, .Of = Of, .Bytes = wrong};
        for (const SessionTag tag : {30u, 31u, 32u})
        {
            B.Received(lie, {.Tag = tag, .In = 4, .Number = 3}, true, Now);
        }
        B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4, .Number = 1}, Now);
        ++index;
        Run(900ms);
    }
    EXPECT_EQ(Came.count(1), 1u);
    EXPECT_LE(Now - begin, 6s);
}

TEST(BlobOffers, AreNotPostponedForLongByAMemberThatSendsPartsWithoutEnd)
{
    const Bytes bulletin = ContentOf(2500);
    const Hash of = Sha256(bulletin);
    BlobExchange honest{1, BlobHeader, 128};
    honest.SetOwn(BlobKind::Bulletin, of, std::make_shared<const Bytes>(bulletin));
    BlobMessage part;
    part.Part = BlobPart{.Kind = BlobKind::Bulletin,
                         .Index = 1,
                         .Size = bulletin.size(),
                         .Of = of,
                         .Bytes = std::span(bulletin).subspan(BlobPartSize, BlobPartSize)};
    std::size_t offers = 0;
    for (TimePoint now{1h}; now < TimePoint{1h} + 20s; now += 50ms)
    {
        honest.Offer(3, now);
        honest.Received(part, {.Tag = 2, .In = 3, .Number = 2}, true, now);
        offers += honest.TakeDue(now) ? 1 : 0;
    }
    EXPECT_GE(offers, 4u);
}

TEST_F(BlobExchanges, TakeNoPartsFromOthersThanTheSource)
{
    B.Want(BlobKind::Permissions, Of, {.Tag = 3, .In = 4}, Now);
    C.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(500ms);
    EXPECT_EQ(Came.count(2), 1u);
    EXPECT_EQ(Came.count(1), 0u);
    // The source is silent, and another session names the same blob.
    Run(BlobExchange::SourcePatience);
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(2s);
    EXPECT_EQ(Came.count(1), 1u);
}

TEST_F(BlobExchanges, RefuseContentWithAnotherHash)
{
    C.SetOwn(BlobKind::Permissions, Of, std::make_shared<const Bytes>(ContentOf(4999)));
    B.Want(BlobKind::Permissions, Of, {.Tag = 3, .In = 4}, Now);
    Run(2s);
    EXPECT_TRUE(Came.empty());
    B.Want(BlobKind::Permissions, Of, {.Tag = 1, .In = 4}, Now);
    Run(2s);
    EXPECT_EQ(Came.count(1), 1u);
}

TEST_F(BlobExchanges, ForgetWhatNobodyNames)
{
    B.Want(BlobKind::Permissions, {9}, {.Tag = 7, .In = 4}, Now);
    Run(30s);
    EXPECT_EQ(B.Wanted(), 0u);
    EXPECT_FALSE(B.Due().has_value());
}

TEST_F(BlobExchanges, WantABoundedNumber)
{
    for (std::uint8_t number = 0; number < 200; ++number)
    {
        B.Want(BlobKind::Permissions, {number, 1}, {.Tag = 7, .In = 4}, Now);
        B.Want(BlobKind::Bulletin, {number, 2}, {.Tag = 7, .In = 4, .Number = number}, Now);
        B.Want(BlobKind::Certificate, {number, 3}, {.Tag = 7, .In = 4}, Now);
    }
    EXPECT_EQ(B.Wanted(), 64u + 16u + 16u);
}

TEST_F(BlobExchanges, BringABulletinWhateverBulletinsAnotherMemberInvents)
{
    A.SetOwn(BlobKind::Bulletin, Of, std::make_shared<const Bytes>(Content));
    for (std::uint8_t number = 0; number < 200; ++number)
    {
        B.Want(BlobKind::Bulletin, {number, 2}, {.Tag = 3, .In = 4, .Number = 3}, Now);
    }
    EXPECT_EQ(B.Wanted(), 1u);
    B.Want(BlobKind::Bulletin, Of, {.Tag = 1, .In = 4, .Number = 1}, Now);
    Run(500ms);
    EXPECT_EQ(Came.count(1), 1u);
}

TEST_F(BlobExchanges, OfferABulletinInTheFormerEpochWhileItIsHeard)
{
    A.SetOwn(BlobKind::Bulletin, Of, std::make_shared<const Bytes>(Content));
    A.Offer(3, Now);
    std::size_t offers = 0;
    for (const TimePoint end = Now + 20s; Now < end; Now += 1ms)
    {
        if (Now < end - 15s)
        {
            A.Offer(3, Now);
        }
        if (const auto sent = A.TakeDue(Now))
        {
            ++offers;
            EXPECT_EQ(sent->In, 3);
            const auto message = ReadBlobMessage(sent->Message);
            ASSERT_TRUE(message && message->Part);
            EXPECT_EQ(message->Part->Index, 0u);
        }
    }
    EXPECT_GE(offers, 3u);
    EXPECT_LE(offers, 6u);
    EXPECT_FALSE(A.Due().has_value());
}

TEST_F(BlobExchanges, LeaveTheOfferToOneOfSeveral)
{
    for (BlobExchange *const each : All)
    {
        each->SetOwn(BlobKind::Bulletin, Of, std::make_shared<const Bytes>(Content));
        each->Offer(3, Now);
    }
    Run(290ms);
    EXPECT_EQ(Messages, 1u);
}

}  // namespace
