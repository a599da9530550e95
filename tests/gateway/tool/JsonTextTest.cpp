#include "JsonText.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include <cstdint>

namespace Rabit::Tool
{
namespace
{

using Json = nlohmann::ordered_json;

TEST(JsonText, NumbersStayNumbersHoweverLarge)
{
    EXPECT_EQ(JsonText(Json{0, -1, 1.5e300, INT64_MIN, UINT64_MAX, nullptr, true, "9"}),
              R"([0,-1,1.5e+300,-9223372036854775808,18446744073709551615,null,true,"9"])");
}

}  // namespace
}  // namespace Rabit::Tool
