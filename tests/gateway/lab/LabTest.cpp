#include <rabit/testing/Lab.h>

#include <gmock/gmock.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace Rabit
{
namespace
{

// A folder with a program that acts as `rabit`.
class LabTest : public testing::Test
{
protected:
    LabTest()
    {
        std::string name = testing::TempDir() + "rabit_lab_XXXXXX";
        _folder = mkdtemp(name.data());
    }
    ~LabTest() override { std::filesystem::remove_all(_folder); }

    std::string Program(const std::string &script) const
    {
        std::string path = _folder / "rabit";
        std::ofstream(path) << "#!/bin/sh\n" << script;
        std::filesystem::permissions(path, std::filesystem::perms::owner_all);
        return path;
    }
    std::string Results() const { return _folder / "results"; }

    std::filesystem::path _folder;
};

TEST_F(LabTest, AScenarioThatPassesIsTrue)
{
    const Lab lab(
        Program("test \"$1 $2 $3 $4\" = 'lab run s.yaml --to' || exit 2; mkdir \"$5\"\n"
                "printf 'met\\tall up within 3s\\tafter 0.4 s\\n' > \"$5/verdicts.txt\"\n"));
    const LabResult result = lab.Run("s.yaml", Results());
    EXPECT_TRUE(result);
    ASSERT_EQ(result.Verdicts.size(), 1U);
    EXPECT_TRUE(result.Verdicts[0].IsMet);
    EXPECT_EQ(result.Verdicts[0].Expected, "all up within 3s");
    EXPECT_EQ(result.Verdicts[0].Seen, "after 0.4 s");
}

TEST_F(LabTest, AnExpectationThatIsNotMetIsPrintedWithItsReason)
{
    const Lab lab(
        Program("mkdir \"$5\"; printf 'met\\ta\\t\\nnot met\\tno false lost\\tground lost uav1\\n' > "
                "\"$5/verdicts.txt\"; exit 1\n"));
    const LabResult result = lab.Run("s.yaml", Results());
    EXPECT_FALSE(result);
    EXPECT_FALSE(result.IsImpossible());
    std::ostringstream text;
    text << result;
    EXPECT_EQ(text.str(),
              "not met: no false lost: ground lost uav1\nexit code 1; " + Results() + "/report.html\n");
}

TEST_F(LabTest, AMachineThatAllowsNoneIsToldApart)
{
    EXPECT_TRUE(Lab(Program("exit 3\n")).Run("s.yaml", Results()).IsImpossible());
}

TEST_F(LabTest, AProgramThatIsNotThereOrIsKilledThrows)
{
    EXPECT_THROW(Lab(_folder / "none").Run("s.yaml", Results()), std::system_error);
    EXPECT_THROW(Lab(Program("kill -9 $$\n")).Run("s.yaml", Results()), std::runtime_error);
}

}  // namespace
}  // namespace Rabit
