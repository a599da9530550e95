#include "constructs.idl.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace
{

using Constructs::Number;
using Constructs::Optional;
using Constructs::Value;

TEST(Union, NewOneSelectsItsFirstMember)
{
    const Value value;
    EXPECT_EQ(value._d(), Basics::Color::RED);
    EXPECT_EQ(value.tiny(), 0);
}

TEST(Union, SettingAMemberSelectsIt)
{
    Value value;
    value.point({1.0, 2.0});
    EXPECT_EQ(value._d(), Basics::Color::GREEN);
    EXPECT_EQ(value.point(), (Basics::Point{1.0, 2.0}));
}

TEST(Union, SelectedMemberCanBeChangedInPlace)
{
    Value value;
    value.point({1.0, 2.0});
    value.point().x = 5.0;
    EXPECT_EQ(value.point().x, 5.0);
}

TEST(Union, ReadingAMemberThatIsNotSelectedThrows)
{
    Value value;
    const Value &readOnly = value;
    EXPECT_THROW(value.point(), std::logic_error);
    EXPECT_THROW(readOnly.point(), std::logic_error);
}

TEST(Union, DiscriminatorMovesOnlyAmongTheLabelsOfOneMember)
{
    Value value;
    value.point({1.0, 2.0});
    value._d(Basics::Color::BLUE);
    EXPECT_EQ(value._d(), Basics::Color::BLUE);
    EXPECT_EQ(value.point().y, 2.0);
    EXPECT_THROW(value._d(Basics::Color::RED), std::logic_error);
    EXPECT_THROW(value._d(static_cast<Basics::Color>(55)), std::logic_error);
    EXPECT_EQ(value._d(), Basics::Color::BLUE);
}

TEST(Union, DefaultCaseTakesEveryValueWithoutACase)
{
    Number number;
    number.list({1, 2}, 1000);
    EXPECT_EQ(number._d(), 1000);
    EXPECT_THROW(number.list({1}, 3), std::logic_error);
    number.list({4});
    EXPECT_NE(number._d(), 1);
    EXPECT_NE(number._d(), -2);
    EXPECT_NE(number._d(), 3);
}

TEST(Union, ValueWithoutACaseSelectsNothing)
{
    Optional optional;
    optional._default();
    EXPECT_FALSE(optional._d());
    EXPECT_THROW(optional.present(), std::logic_error);
}

TEST(Union, EqualityLooksAtDiscriminatorAndMember)
{
    Value a;
    Value b;
    a.point({1.0, 2.0}, Basics::Color::GREEN);
    b.point({1.0, 2.0}, Basics::Color::GREEN);
    EXPECT_EQ(a, b);
    b._d(Basics::Color::BLUE);
    EXPECT_NE(a, b);
    b.point({1.0, 3.0}, Basics::Color::GREEN);
    EXPECT_NE(a, b);
}

TEST(Union, TextShowsTheSelectedMember)
{
    Value value;
    value.tiny(4);
    EXPECT_EQ(ToString(value), "{tiny: 4}");
    Optional optional;
    optional._default();
    EXPECT_EQ(ToString(optional), "{}");
}

}  // namespace
