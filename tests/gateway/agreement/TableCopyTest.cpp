#include "agreement/TableCopy.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "SimRandom.h"
#include "agreement/TableMessages.h"

namespace Rabit
{
namespace
{

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using TableAnswer = TableCopy::Answer;

TableEntry WrittenEntry(const std::string &key, std::uint64_t count, const std::string &writer,
                        const std::string &value)
{
    TableEntry entry;
    entry.Key = key;
    entry.Value = LastWritten{.Count = count, .Writer = writer, .Value = value};
    return entry;
}

TableEntry UnionEntry(const std::string &key, const std::vector<std::size_t> &numbers)
{
    TableEntry entry;
    entry.Key = key;
    auto &set = entry.Value.emplace<NumberSet>();
    for (const std::size_t number : numbers)
    {
        set.set(number);
    }
    return entry;
}

TableEntry MaximumEntry(const std::string &key, std::int64_t number)
{
    TableEntry entry;
    entry.Key = key;
    entry.Value.emplace<std::int64_t>(number);
    return entry;
}

// One of few values, so that equal counts, equal writers and different merges meet.
TableEntry SomeTableEntry(Sim::SimRandom &random)
{
    const std::string key(1, static_cast<char>('a' + random.Index(5)));
    switch (random.Index(3))
    {
        case 0:
            return WrittenEntry(key, random.Index(3), random.Chance(0.5) ? "uav1" : "uav2",
                                std::string(random.Index(3), 'x'));
        case 1:
            return UnionEntry(key, {random.Index(512), random.Index(512)});
        default:
            return MaximumEntry(key, random.Between(-3, 3));
    }
}

// The count and the writer of a key that was written.
std::pair<std::uint64_t, std::string> VersionOf(const TableCopy &table, const std::string &key)
{
    const auto &written = std::get<LastWritten>(*table.Find(key));
    return {written.Count, written.Writer};
}

std::string ValueOf(const TableCopy &table, const std::string &key)
{
    return std::get<LastWritten>(*table.Find(key)).Value;
}

TEST(TableMerges, AreCommutativeAssociativeAndIdempotent)
{
    Sim::SimRandom random(1);
    for (int i = 0; i < 20000; ++i)
    {
        const TableValue a = SomeTableEntry(random).Value;
        const TableValue b = SomeTableEntry(random).Value;
        const TableValue c = SomeTableEntry(random).Value;
        ASSERT_EQ(MergedTableValue(a, b), MergedTableValue(b, a)) << i;
        ASSERT_EQ(MergedTableValue(MergedTableValue(a, b), c), MergedTableValue(a, MergedTableValue(b, c)))
            << i;
        ASSERT_EQ(MergedTableValue(a, a), a) << i;
        ASSERT_EQ(MergedTableValue(MergedTableValue(a, b), b), MergedTableValue(a, b)) << i;
    }
}

TEST(TableMerges, GiveTheSameTableInWhateverOrderAndHoweverOften)
{
    for (std::uint64_t seed = 1; seed <= 500; ++seed)
    {
        Sim::SimRandom random(seed);
        std::vector<TableEntry> entries;
        for (int i = 0; i < 20; ++i)
        {
            entries.push_back(SomeTableEntry(random));
        }
        TableCopy one("one", 1);
        for (const TableEntry &entry : entries)
        {
            one.Meet(entry);
        }
        TableCopy other("other", 2);
        for (int i = 0; i < 20; ++i)
        {
            other.Meet(entries[random.Index(entries.size())]);
        }
        for (auto entry = entries.rbegin(); entry != entries.rend(); ++entry)
        {
            other.Meet(*entry);
        }
        ASSERT_EQ(one.Entries(), other.Entries()) << "seed " << seed;
        ASSERT_EQ(one.Digest(), other.Digest()) << "seed " << seed;
    }
}

TEST(TableCopies, KeepTheWriteWithTheHigherCount)
{
    TableCopy table("uav1", 1);
    table.Meet(WrittenEntry("key", 7, "uav2", "new"));
    table.Meet(WrittenEntry("key", 6, "uav3", "old"));
    EXPECT_EQ(ValueOf(table, "key"), "new");
}

TEST(TableCopies, StartACountAtTheWholeIncarnation)
{
    TableCopy table("uav1", 0xfedcba9876543210);
    ASSERT_EQ(table.Write("key", "value"), TableAnswer::Done);
    EXPECT_EQ(VersionOf(table, "key").first, 0xfedcba9876543210U);
}

TEST(TableCopies, WriteWithACountAboveAllThatTheyMet)
{
    TableCopy table("uav1", 5);
    table.Meet(WrittenEntry("key", 9, "uav2", "theirs"));
    ASSERT_EQ(table.Write("key", "own"), TableAnswer::Done);
    EXPECT_EQ(VersionOf(table, "key"), std::pair(std::uint64_t{10}, std::string("uav1")));
}

TEST(TableCopies, StayAsTheyAreIfTheValueOfAKeyIsWrittenAgain)
{
    TableCopy table("uav1", 5);
    table.Write("key", "value");
    const std::uint64_t digest = table.Digest();
    EXPECT_EQ(table.Write("key", "value"), TableAnswer::Done);
    EXPECT_EQ(table.Digest(), digest);
}

TEST(TableCopies, HaveAllNumbersThatWereAddedToASet)
{
    TableCopy table("uav1", 1);
    ASSERT_EQ(table.Add("flown", 0), TableAnswer::Done);
    ASSERT_EQ(table.Add("flown", 511), TableAnswer::Done);
    table.Meet(UnionEntry("flown", {17}));
    EXPECT_EQ(*table.Find("flown"), UnionEntry("flown", {0, 17, 511}).Value);
}

TEST(TableCopies, HaveTheHighestNumber)
{
    TableCopy table("uav1", 1);
    ASSERT_EQ(table.Raise("round", -3), TableAnswer::Done);
    table.Meet(MaximumEntry("round", 2));
    ASSERT_EQ(table.Raise("round", 1), TableAnswer::Done);
    EXPECT_EQ(*table.Find("round"), MaximumEntry("round", 2).Value);
}

TEST(TableCopies, TellTheKeysThatHaveChangedOnce)
{
    TableCopy table("uav1", 1);
    table.Raise("own", 1);
    table.Meet(MaximumEntry("met", 1));
    EXPECT_THAT(table.TakeChanged(), ElementsAre("met", "own"));
    table.Meet(MaximumEntry("met", 0));
    EXPECT_THAT(table.TakeChanged(), IsEmpty());
}

// A sum of the entries' hashes would often be the same.
TEST(TableCopies, HaveAnotherDigestIfTwoKeysSwapTheirValues)
{
    for (char c = 'b'; c <= 'z'; ++c)
    {
        const std::string value(1, c);
        TableCopy one("uav1", 1);
        one.Write("cell 1", "a");
        one.Write("cell 2", value);
        TableCopy other("uav1", 1);
        other.Write("cell 1", value);
        other.Write("cell 2", "a");
        EXPECT_NE(one.Digest(), other.Digest()) << c;
    }
}

TEST(TableCopies, GiveTheEntriesWhoseHashesAnotherTableLacks)
{
    TableCopy one("uav1", 1);
    one.Raise("same", 1);
    one.Raise("other value", 1);
    one.Raise("no such key there", 1);
    TableCopy other("uav2", 1);
    other.Raise("same", 1);
    other.Raise("other value", 2);
    for (std::uint32_t salt = 0; salt < 10; ++salt)
    {
        EXPECT_THAT(one.EntriesBeside(other.Hashes(salt), salt),
                    ElementsAre(MaximumEntry("no such key there", 1), MaximumEntry("other value", 1)));
    }
}

// Else two entries with one hash would stay apart.
TEST(TableCopies, HashTheirEntriesAnewUnderAnotherSalt)
{
    TableCopy table("uav1", 1);
    table.Raise("key", 1);
    EXPECT_NE(table.Hashes(1), table.Hashes(2));
}

TEST(TableCopies, GiveAKeyThatHasTwoMergesToTheHigherOneAndTellTheLossOnce)
{
    TableCopy lower("uav1", 1);
    lower.Write("key", "lost");
    lower.Meet(UnionEntry("key", {3}));
    TableCopy higher("uav2", 1);
    higher.Add("key", 3);
    higher.Meet(WrittenEntry("key", 1, "uav1", "lost"));
    EXPECT_EQ(lower.Entries(), higher.Entries());
    EXPECT_THAT(lower.TakeConflicts(), ElementsAre("key"));
    EXPECT_THAT(higher.TakeConflicts(), ElementsAre("key"));
    EXPECT_THAT(higher.TakeConflicts(), IsEmpty());
}

TEST(TableCopies, RefuseACallWithAnotherMerge)
{
    TableCopy table("uav1", 1);
    table.Write("key", "value");
    EXPECT_EQ(table.Raise("key", 1), TableAnswer::OtherMerge);
    EXPECT_EQ(ValueOf(table, "key"), "value");
}

TEST(TableCopies, WriteAgainAboveAWriteOfAFormerIncarnation)
{
    TableCopy table("uav1", 3);
    table.Write("key", "new");
    table.Meet(WrittenEntry("key", 8, "uav1", "former"));
    EXPECT_EQ(ValueOf(table, "key"), "new");
    EXPECT_EQ(VersionOf(table, "key").first, 9U);
    EXPECT_EQ(table.Rewritten(), 1U);
}

TEST(TableCopies, WriteAgainAboveAWriteOfAFormerIncarnationWithTheSameCount)
{
    TableCopy table("uav1", 3);
    table.Write("key", "a");
    table.Meet(WrittenEntry("key", 3, "uav1", "b"));
    EXPECT_EQ(ValueOf(table, "key"), "a");
}

TEST(TableCopies, TakeTheWriteOfAFormerIncarnationIfThisOneHasNotWritten)
{
    TableCopy table("uav1", 3);
    table.Meet(WrittenEntry("key", 8, "uav1", "former"));
    EXPECT_EQ(ValueOf(table, "key"), "former");
}

// Another node has written after this incarnation, and knew its value.
TEST(TableCopies, KeepALaterWriteOfAnotherNodeOverThatOfAFormerIncarnation)
{
    TableCopy table("uav1", 3);
    table.Write("key", "new");
    table.Meet(WrittenEntry("key", 4, "uav2", "newer"));
    table.Meet(WrittenEntry("key", 8, "uav1", "former"));
    EXPECT_EQ(ValueOf(table, "key"), "newer");
}

// Two live nodes have one name.
TEST(TableCopies, StopWritingAgainIfTheirNameIsTaken)
{
    TableCopy one("uav1", 3);
    TableCopy other("uav1", 4);
    one.Write("key", "one");
    other.Write("key", "other");
    for (int i = 0; i < 100; ++i)
    {
        one.Meet(other.Entries().front());
        other.Meet(one.Entries().front());
    }
    EXPECT_EQ(one.Entries(), other.Entries());
    EXPECT_LE(one.Rewritten(), static_cast<std::uint64_t>(TableCopy::MostRewrites));
}

TEST(TableCopies, RefuseToWriteAboveTheHighestCount)
{
    TableCopy table("uav1", 1);
    table.Meet(WrittenEntry("key", std::numeric_limits<std::uint64_t>::max(), "uav2", "theirs"));
    EXPECT_EQ(table.Write("key", "own"), TableAnswer::CountAtEnd);
    EXPECT_EQ(ValueOf(table, "key"), "theirs");
}

TEST(TableCopies, RefuseAnEmptyOrALongKey)
{
    TableCopy table("uav1", 1);
    EXPECT_EQ(table.Write("", "value"), TableAnswer::BadKey);
    EXPECT_EQ(table.Write(std::string(65, 'k'), "value"), TableAnswer::BadKey);
    EXPECT_EQ(table.Write(std::string(64, 'k'), "value"), TableAnswer::Done);
}

TEST(TableCopies, RefuseALongValue)
{
    TableCopy table("uav1", 1);
    EXPECT_EQ(table.Write("key", std::string(65, 'v')), TableAnswer::BadValue);
    EXPECT_EQ(table.Write("key", std::string(64, 'v')), TableAnswer::Done);
}

TEST(TableCopies, RefuseANumberThatASetCannotHave)
{
    TableCopy table("uav1", 1);
    EXPECT_EQ(table.Add("key", 512), TableAnswer::BadValue);
    EXPECT_EQ(table.Find("key"), nullptr);
}

TEST(TableCopies, RefuseMoreKeysThanTheyHaveRoomFor)
{
    TableCopy table("uav1", 1);
    for (std::size_t i = 0; i < TableCopy::MostKeys; ++i)
    {
        ASSERT_EQ(table.Raise("key " + std::to_string(i), 0), TableAnswer::Done);
    }
    EXPECT_EQ(table.Raise("one more", 0), TableAnswer::Full);
    EXPECT_THAT(std::string(TableAnswer::Full), HasSubstr("256 other keys"));
    EXPECT_TRUE(table.TakeRefusal());
    EXPECT_FALSE(table.TakeRefusal());
    EXPECT_EQ(table.Meet(MaximumEntry("one more", 0)), TableAnswer::Full);
    EXPECT_TRUE(table.TakeRefusal());
    EXPECT_EQ(table.Raise("key 7", 1), TableAnswer::Done);
}

TEST(TableCopies, NeedTheNameOfANode)
{
    EXPECT_THROW(TableCopy("", 1), std::invalid_argument);
    EXPECT_THROW(TableCopy(std::string(65, 'n'), 1), std::invalid_argument);
}

TEST(TableMessages, AreReadAsTheyWereWritten)
{
    const TableSummary summary{.Salt = 3, .Hashes = {5, 6, 0xffffffff}};
    EXPECT_EQ(DecodeTableSummary(EncodeTableSummary(summary)), summary);
    const std::vector<TableEntry> entries = {
        WrittenEntry("a", 7, "uav1", "value"),
        WrittenEntry("b", 0, "uav1", ""),
        UnionEntry("c", {}),
        UnionEntry("d", {0, 9, 511}),
        MaximumEntry("e", -1),
    };
    const auto datagrams = EncodeTableEntries(entries);
    ASSERT_EQ(datagrams.size(), 1U);
    EXPECT_EQ(DecodeTableEntries(datagrams.front()), entries);
}

TEST(TableMessages, AreRefusedIfBytesAreMissingOrLeft)
{
    const std::vector<TableEntry> entries = {WrittenEntry("a", 7, "uav1", "value"), UnionEntry("b", {9}),
                                             MaximumEntry("c", 1)};
    auto bytes = EncodeTableEntries(entries).front();
    ASSERT_TRUE(DecodeTableEntries(bytes));
    for (std::size_t size = 0; size < bytes.size(); ++size)
    {
        EXPECT_FALSE(DecodeTableEntries(std::span(bytes).first(size))) << size;
    }
    bytes.push_back(0);
    EXPECT_FALSE(DecodeTableEntries(bytes));
}

TEST(TableMessages, AreRefusedBeyondABound)
{
    TableSummary summary{.Hashes = std::vector<std::uint32_t>(256)};
    EXPECT_TRUE(DecodeTableSummary(EncodeTableSummary(summary)));
    summary.Hashes.push_back(0);
    EXPECT_FALSE(DecodeTableSummary(EncodeTableSummary(summary)));
}

TEST(TableMessages, AreRefusedWithAnEntryThatIsNotGood)
{
    const std::string longer(65, 'x');
    for (const TableEntry &entry :
         {WrittenEntry("", 1, "uav1", ""), WrittenEntry(longer, 1, "uav1", ""), WrittenEntry("a", 1, "", ""),
          WrittenEntry("a", 1, longer, ""), WrittenEntry("a", 1, "uav1", longer), MaximumEntry("", 1)})
    {
        EXPECT_FALSE(DecodeTableEntries(EncodeTableEntries(std::vector{entry}).front()));
    }
}

TEST(TableMessages, AreRefusedWithAnUnknownMerge)
{
    auto bytes = EncodeTableEntries(std::vector{MaximumEntry("a", 1)}).front();
    bytes[2] = 3;
    EXPECT_FALSE(DecodeTableEntries(bytes));
}

TEST(TableMessages, HaveEntriesInDatagramsOf1200Bytes)
{
    std::vector<TableEntry> entries;
    for (int i = 0; i < 256; ++i)
    {
        std::string key = std::to_string(i);
        key.resize(64, 'k');
        entries.push_back(WrittenEntry(key, 1, std::string(64, 'w'), std::string(64, 'v')));
    }
    std::vector<TableEntry> read;
    for (const auto &datagram : EncodeTableEntries(entries))
    {
        EXPECT_LE(datagram.size(), 1200U);
        const auto some = DecodeTableEntries(datagram);
        ASSERT_TRUE(some);
        read.insert(read.end(), some->begin(), some->end());
    }
    EXPECT_EQ(read, entries);
}

// 299 of them fit in 1,200 bytes, and the number of entries has one byte.
TEST(TableMessages, HaveAtMost255EntriesInADatagram)
{
    const std::vector<TableEntry> entries(256, UnionEntry("a", {}));
    EXPECT_EQ(EncodeTableEntries(entries).size(), 2U);
}

}  // namespace
}  // namespace Rabit
