// The token of a server, and the node that a folder of keys is for.
#include <gtest/gtest.h>
#include <rabit/keys/AccessToken.h>
#include <rabit/keys/KeysError.h>
#include <rabit/keys/NodeOfKeys.h>
#include <rabit/keys/TokenGuard.h>

#include <boost/asio/ip/address.hpp>

#include <chrono>
#include <filesystem>
#include <fstream>
#include <string>

namespace
{

using namespace std::chrono_literals;

// [token]
TEST(KeysExample, TheTokenOfAServerStaysTheSame)
{
    const std::string folder = ::testing::TempDir() + "rabit-token-" + std::to_string(::getpid());
    std::filesystem::create_directories(folder);
    const std::string file = folder + "/token";
    const std::string token = Rabit::Keys::AccessTokenIn(file);
    EXPECT_EQ(Rabit::Keys::AccessTokenIn(file), token);
    std::filesystem::remove(file);

    std::ofstream(file) << token;
    std::filesystem::permissions(file, std::filesystem::perms::others_read,
                                 std::filesystem::perm_options::add);
    EXPECT_THROW(Rabit::Keys::AccessTokenIn(file), Rabit::Keys::KeysError);
    std::filesystem::remove_all(folder);
}
// [/token]

// [node]
TEST(KeysExample, AFolderWithoutKeysIsForNoNode)
{
    try
    {
        Rabit::Keys::NodeOfKeys("/nowhere/uav1");
        FAIL();
    }
    catch (const Rabit::Keys::KeysError &error)
    {
        EXPECT_STREQ(error.what(), "there is no folder of keys /nowhere/uav1; `rabit keys add` makes one");
    }
}
// [/node]

// [guard]
TEST(KeysExample, WrongTokensMakeAnAddressWait)
{
    const std::string token = Rabit::Keys::MakeAccessToken();
    Rabit::Keys::TokenGuard guard(token, "The page");
    const auto visitor = boost::asio::ip::make_address("192.0.2.1");
    const Rabit::Keys::TokenGuard::Time now{};
    EXPECT_TRUE(guard.IsRight(visitor, token, now));
    EXPECT_EQ(guard.PauseFor(visitor, now), 0ms);
    for (int attempt = 0; attempt < 20; ++attempt)
    {
        EXPECT_FALSE(guard.IsRight(visitor, "a guess", now));
    }
    EXPECT_GT(guard.PauseFor(visitor, now), 0ms);
    EXPECT_TRUE(guard.Line(now));
}
// [/guard]

}  // namespace
