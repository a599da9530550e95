#include "PictureStore.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

namespace
{
using Ground::PictureStore;

std::vector<std::uint8_t> Jpeg(std::uint8_t last, std::size_t size = 5)
{
    std::vector<std::uint8_t> bytes(size, last);
    bytes[0] = 0xFF;
    bytes[1] = 0xD8;
    bytes[2] = 0xFF;
    return bytes;
}

TEST(PictureStore, KeepsTheLatestOfEachAircraft)
{
    PictureStore store;
    EXPECT_TRUE(store.Put("uav1", Jpeg(1)));
    EXPECT_TRUE(store.Put("uav2", Jpeg(2)));
    EXPECT_TRUE(store.Put("uav1", Jpeg(3)));
    EXPECT_EQ(*store.Get("uav1"), Jpeg(3));
    EXPECT_EQ(*store.Get("uav2"), Jpeg(2));
    EXPECT_EQ(store.Get("uav3"), nullptr);
}

TEST(PictureStore, RefusesWhatIsNoJpegAndKeepsWhatItHas)
{
    PictureStore store;
    EXPECT_TRUE(store.Put("uav1", Jpeg(1)));
    EXPECT_FALSE(store.Put("uav1", {}));
    EXPECT_FALSE(store.Put("uav1", {'<', 's', 'v', 'g', '>'}));
    EXPECT_FALSE(store.Put("uav1", Jpeg(1, PictureStore::MaxBytes + 1)));
    EXPECT_EQ(*store.Get("uav1"), Jpeg(1));
}

TEST(PictureStore, KeepsPicturesOfSoManyAircraftAndNoMore)
{
    PictureStore store;
    for (std::size_t i = 0; i < PictureStore::MaxNodes; ++i)
        ASSERT_TRUE(store.Put("uav" + std::to_string(i), Jpeg(1)));
    EXPECT_FALSE(store.Put("one more", Jpeg(1)));
    EXPECT_TRUE(store.Put("uav0", Jpeg(2)));
}

}  // namespace
