#include <gmock/gmock.h>
#include <rabit/transport/TransportFactory.h>

#include <algorithm>
#include <string>
#include <utility>

namespace
{

using testing::HasSubstr;

TEST(TransportFactory, MakesEachTransportThatItLists)
{
    ASSERT_FALSE(Rabit::AvailableTransports().empty());
    for (const auto &name : Rabit::AvailableTransports())
    {
        EXPECT_EQ(Rabit::MakeTransport(name)->Name(), name);
    }
}

TEST(TransportFactory, NamesTheTransportsThatExistWhenAskedForAnother)
{
    try
    {
        Rabit::MakeTransport("fastdsd");
        FAIL() << "there is no such transport";
    }
    catch (const Rabit::TransportError &error)
    {
        EXPECT_THAT(error.what(), HasSubstr("fastdsd"));
        for (const auto &name : Rabit::AvailableTransports())
        {
            EXPECT_THAT(error.what(), HasSubstr(name));
        }
    }
}

TEST(TransportFactory, SaysWhichOptionWouldHaveBuiltABackendThatWasLeftOut)
{
    const auto built = Rabit::AvailableTransports();
    const std::pair<const char *, const char *> backends[] = {{"fastdds", "RABIT_WITH_FASTDDS"},
                                                              {"cyclonedds", "RABIT_WITH_CYCLONEDDS"}};
    for (const auto &[name, option] : backends)
    {
        std::string said;
        try
        {
            EXPECT_EQ(Rabit::MakeTransport(name)->Name(), name);
        }
        catch (const Rabit::TransportError &error)
        {
            said = error.what();
            EXPECT_EQ(error.Setting(), "transport");
        }
        const bool isBuilt = std::find(built.begin(), built.end(), name) != built.end();
        EXPECT_EQ(said.find(option) == std::string::npos, isBuilt) << said;
        EXPECT_EQ(said.find('\n'), std::string::npos);
    }
}

}  // namespace
