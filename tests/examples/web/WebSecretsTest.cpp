#include "WebSecrets.h"

#include "WebAddress.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <sys/stat.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace
{
using testing::ElementsAre;
using testing::HasSubstr;
namespace fs = std::filesystem;

constexpr std::time_t Now = 1'795'000'000;
constexpr std::time_t Day = 24 * 60 * 60;
const Ground::WebNames Names{{"field", "field.local"}, {"10.0.0.5", "2001:db8::1"}};

class WebSecretsTest : public testing::Test
{
protected:
    fs::path _work;
    std::string _folder;

    void SetUp() override
    {
        std::string name = (fs::temp_directory_path() / "web-secrets-XXXXXX").string();
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        _work = name;
        _folder = (_work / "web").string();
    }
    void TearDown() override { fs::remove_all(_work); }

    std::string File(const char *name) const { return _folder + "/" + name; }
    void Write(const char *name, const std::string &text, fs::perms perms = fs::perms(0600)) const
    {
        std::ofstream(File(name), std::ios::trunc) << text;
        fs::permissions(File(name), perms);
    }
    Ground::WebSecrets Read(std::time_t now = Now, bool mayWrite = true) const
    {
        return Ground::WebSecretsIn(_folder, Names, now, mayWrite);
    }
    std::string Refusal(std::time_t now = Now) const
    {
        try
        {
            Read(now);
            return "accepted";
        }
        catch (const Ground::WebServerError &error)
        {
            return error.what();
        }
    }
    unsigned ModeOf(const std::string &file) const
    {
        struct stat status = {};
        EXPECT_EQ(::stat(file.c_str(), &status), 0) << file;
        return status.st_mode & 07777U;
    }
};

TEST_F(WebSecretsTest, AreOthersAtEachStartUnlessTheyAreKept)
{
    const auto one = Ground::MakeWebSecrets(Names, Now);
    const auto other = Ground::MakeWebSecrets(Names, Now);
    EXPECT_NE(one.Token, other.Token);
    EXPECT_NE(one.Key, other.Key);
    EXPECT_EQ(Ground::WhyNotServe(one.Certificate, one.Key, "it", Now), "");
}

TEST_F(WebSecretsTest, AreATokenAloneWithoutTls)
{
    const auto one = Ground::MakeWebToken();
    EXPECT_FALSE(one.HasTls());
    EXPECT_EQ(one.Token.size(), 32u);
    EXPECT_NE(one.Token, Ground::MakeWebToken().Token);
    EXPECT_TRUE(Ground::MakeWebSecrets(Names, Now).HasTls());
}

TEST_F(WebSecretsTest, StayTheSameInAFolderThatIsForItsOwnerAlone)
{
    const auto first = Read();
    const auto second = Read(Now + 300 * Day);
    EXPECT_EQ(first.Token, second.Token);
    EXPECT_EQ(first.Key, second.Key);
    EXPECT_EQ(first.Certificate, second.Certificate);
    EXPECT_EQ(ModeOf(_folder), 0700u);
    EXPECT_EQ(ModeOf(File("private_key.pem")), 0600u);
    EXPECT_EQ(ModeOf(File("token")), 0600u);
}

TEST_F(WebSecretsTest, AreNotWrittenByACheck)
{
    EXPECT_NE(Read(Now, false).Token, "");
    EXPECT_FALSE(fs::exists(_folder));
}

TEST_F(WebSecretsTest, AreCompletedWhereAStartWasCutShort)
{
    const auto first = Read();
    fs::remove(File("certificate.pem"));
    fs::remove(File("token"));
    const auto second = Read();
    EXPECT_EQ(first.Key, second.Key);
    EXPECT_NE(first.Token, second.Token);
    EXPECT_EQ(Ground::WhyNotServe(second.Certificate, second.Key, "it", Now), "");
}

TEST_F(WebSecretsTest, AreRefusedIfOthersMayReadThem)
{
    Read();
    fs::permissions(File("token"), fs::perms(0640));
    EXPECT_THAT(Refusal(), HasSubstr("token is not for its owner alone (mode 640)"));
    fs::permissions(File("token"), fs::perms(0600));
    fs::permissions(File("private_key.pem"), fs::perms(0604));
    EXPECT_THAT(Refusal(), HasSubstr("private_key.pem is not for its owner alone (mode 604)"));
}

TEST_F(WebSecretsTest, AreRefusedWithWhatIsWrongWithTheCertificate)
{
    const auto first = Read();
    EXPECT_THAT(Refusal(Now + 400 * Day), HasSubstr("certificate.pem ended on 20"));
    EXPECT_THAT(Refusal(0), HasSubstr("the clock says 1970-01-01, and"));
    Write("certificate.pem", first.Certificate.substr(0, first.Certificate.size() / 2));
    EXPECT_THAT(Refusal(), HasSubstr("certificate.pem is no certificate"));
    Write("certificate.pem", Ground::MakeWebSecrets(Names, Now).Certificate);
    EXPECT_THAT(Refusal(), HasSubstr("certificate.pem is for another key"));
    fs::remove(File("private_key.pem"));
    EXPECT_THAT(Refusal(), HasSubstr("private_key.pem is missing"));
}

TEST_F(WebSecretsTest, SayInOneLineWhereTheyCannotBeKept)
{
    _folder = (_work / "nowhere" / "web").string();
    EXPECT_THAT(Refusal(), HasSubstr("nowhere/web"));
    EXPECT_THAT(Refusal(), testing::Not(HasSubstr("\n")));
}

TEST_F(WebSecretsTest, HaveACertificateForTheNamesOfThisMachine)
{
    const auto secrets = Ground::MakeWebSecrets(Names, Now);
    EXPECT_THAT(Ground::NamesIn(secrets.Certificate), ElementsAre("field", "field.local"));
    EXPECT_THAT(Ground::FingerprintOf(secrets.Certificate),
                testing::MatchesRegex("([0-9A-F][0-9A-F]:)+[0-9A-F][0-9A-F]"));
    EXPECT_EQ(Ground::FingerprintOf(secrets.Certificate).size(), 95u);
}

TEST_F(WebSecretsTest, HaveACertificateWithoutNamesWhereThereAreNone)
{
    const auto secrets = Ground::MakeWebSecrets({}, Now);
    EXPECT_THAT(Ground::NamesIn(secrets.Certificate), testing::IsEmpty());
    EXPECT_EQ(Ground::WhyNotServe(secrets.Certificate, secrets.Key, "it", Now), "");
}

}  // namespace
