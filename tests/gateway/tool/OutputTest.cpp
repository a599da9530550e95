#include "Output.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cstdint>

namespace Rabit::Tool
{
namespace
{

using Json = nlohmann::ordered_json;

TEST(Output, IntegersThatADoubleCannotHoldAreText)
{
    constexpr std::int64_t exact = std::int64_t{1} << 53;
    EXPECT_EQ(
        Output::JsonText(Json{exact, -exact, exact + 1, -exact - 1, UINT64_MAX}),
        R"([9007199254740992,-9007199254740992,"9007199254740993","-9007199254740993","18446744073709551615"])");
    EXPECT_EQ(Output::JsonText({{"a", {{"b", {UINT64_MAX}}}}}), R"({"a":{"b":["18446744073709551615"]}})");
}

TEST(Output, OtherNumbersStayNumbers)
{
    EXPECT_EQ(Output::JsonText(Json{0, -1, 1.5e300, nullptr, true, "9"}), R"([0,-1,1.5e+300,null,true,"9"])");
}

}  // namespace
}  // namespace Rabit::Tool
