#include "backfill/ReadLedger.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "../../NoDescriptors.h"

namespace Rabit::Backfill
{
namespace
{

class ReadLedgerTest : public testing::Test
{
protected:
    ReadLedgerTest()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "ledgerXXXXXX").string();
        folder = ::mkdtemp(pattern.data());
    }
    ~ReadLedgerTest() override { std::filesystem::remove_all(folder); }

    std::filesystem::path folder;
    Ledger ledger;
};

TEST_F(ReadLedgerTest, WithoutRecordingsAllIsRead)
{
    EXPECT_TRUE(ReadLedger(folder.string(), "ground", 0, ledger));
    EXPECT_TRUE(ReadLedger((folder / "none").string(), "ground", 0, ledger)) << "the recorder makes it later";
}

TEST_F(ReadLedgerTest, RecordingsThatCannotBeReadNowAreNotTakenForNone)
{
    std::ofstream(folder / "ground_000001_20261123T024640Z.mcap") << "a file that is begun";
    for (const unsigned spare : {0U, 1U})
    {
        const NoDescriptors none(spare);
        EXPECT_EQ(ReadLedger(folder.string(), "ground", 0, ledger), spare > 0);
    }
    EXPECT_TRUE(ReadLedger(folder.string(), "ground", 0, ledger));
}

}  // namespace
}  // namespace Rabit::Backfill
