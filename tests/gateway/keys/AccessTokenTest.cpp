// The token of a server: random, in memory or in a file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rabit/keys/AccessToken.h>
#include <rabit/keys/KeysError.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <string>

namespace
{

namespace fs = std::filesystem;
using Rabit::Keys::AccessTokenIn;
using testing::HasSubstr;

class AccessTokenTest : public testing::Test
{
protected:
    const fs::path _folder =
        fs::path(testing::TempDir()) / ("access_token_" + Rabit::Keys::MakeAccessToken());
    const std::string _file = (_folder / "token").string();

    AccessTokenTest() { fs::create_directory(_folder); }
    ~AccessTokenTest() override { fs::remove_all(_folder); }
    void Write(const std::string &text) const
    {
        std::ofstream(_file) << text;
        fs::permissions(_file, fs::perms(0600));
    }
    std::string Refusal() const
    {
        try
        {
            return "the token " + AccessTokenIn(_file);
        }
        catch (const Rabit::Keys::KeysError &error)
        {
            return error.what();
        }
    }
};

TEST_F(AccessTokenTest, HasItsOwn128BitsEachTime)
{
    std::set<std::string> tokens;
    for (int i = 0; i < 100; ++i)
    {
        tokens.insert(Rabit::Keys::MakeAccessToken());
    }
    EXPECT_EQ(tokens.size(), 100u);
    EXPECT_EQ(tokens.begin()->size(), 32u);
    EXPECT_EQ(tokens.begin()->find_first_not_of("0123456789abcdef"), std::string::npos);
}

TEST_F(AccessTokenTest, StaysTheSameInAFileThatIsForItsOwnerAlone)
{
    const std::string first = AccessTokenIn(_file);
    EXPECT_EQ(AccessTokenIn(_file), first);
    EXPECT_EQ(fs::status(_file).permissions(), fs::perms(0600));
    fs::permissions(_file, fs::perms(0640));
    EXPECT_THAT(Refusal(), HasSubstr("token is not for its owner alone (mode 640)"));
}

TEST_F(AccessTokenTest, IsNotWrittenByACheck)
{
    EXPECT_EQ(AccessTokenIn(_file, false).size(), 32u);
    EXPECT_FALSE(fs::exists(_file));
}

TEST_F(AccessTokenTest, MayBeChosenUnlessItCouldBeGuessed)
{
    Write("a-token_OF-one-s-own-42\n");
    EXPECT_EQ(AccessTokenIn(_file), "a-token_OF-one-s-own-42");
    for (const std::string &token :
         {std::string(), std::string("secret"), std::string(21, 'x'), std::string(129, 'x'),
          std::string("with spaces in between it"), std::string("semicolon;semicolon;semi"),
          std::string("line\r\nSet-Cookie: a-a-a-a")})
    {
        Write(token);
        EXPECT_THAT(Refusal(), HasSubstr("/token has no token: 22 to 128 letters, digits, - and _")) << token;
    }
}

}  // namespace
