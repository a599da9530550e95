#include "CycloneValues.h"

#include "constructs.h"
#include "keys.h"

#include <math.h>
#include <string.h>

#define LIST(buffer, count)                                                             \
    {                                                                                   \
        ._maximum = (count), ._length = (count), ._buffer = (buffer), ._release = false \
    }

static Constructs_Texts TextsFull(void)
{
    static char words[2][4] = {"abc", ""};
    Constructs_Texts value = {.free = "gr\xc3\xbc\xc3\x9f dich", .lines = {"", "two"}};
    strcpy(value.bounded, "four");
    strcpy(value.label, "eight888");
    value.words = (dds_sequence_string3)LIST(words, 2);
    return value;
}

static Constructs_Choices ChoicesFull(void)
{
    static Constructs_Small smalls[3] = {Constructs_S255, Constructs_S0, Constructs_S1};
    return (Constructs_Choices){.m = Constructs_BUSY,
                                .gap = 9,
                                .tiny = Constructs_S255,
                                .middle = Constructs_M40000,
                                .color = Basics_BLUE,
                                .f8 = 0x81,
                                .f16 = 0x8001,
                                .f32 = 0x80000003,
                                .f64 = 0x8000000000000001ULL,
                                .smalls = LIST(smalls, 3),
                                .more = {1, 0x8000, 0}};
}

static Constructs_Collections CollectionsFull(void)
{
    static uint8_t bytes[5] = {1, 2, 3, 4, 5};
    static bool flags[2] = {true, false};
    static int16_t shorts[3] = {-1, 0, 1};
    static double reals[1] = {2.5};
    static double row[2] = {1.0, -1.0};
    static Constructs_Doubles rows[2] = {LIST(row, 2), LIST(NULL, 0)};
    static Basics_Point points[1] = {{1.0, 2.0}};
    static Basics_Point few[2] = {{3.0, 4.0}, {5.0, 6.0}};
    static uint8_t innermost[3] = {7, 8, 9};
    static dds_sequence_octet inner[2] = {LIST(NULL, 0), LIST(innermost, 3)};
    static dds_sequence_sequence_octet deep[1] = {LIST(inner, 2)};
    static Constructs_Grid grids[1] = {{{1, 2, 3, 4}, {5, 6, 7, 8}, {9, 10, 11, 12}}};
    Constructs_Collections value = {.bytes = LIST(bytes, 5),
                                    .flags = LIST(flags, 2),
                                    .shorts = LIST(shorts, 3),
                                    .reals = LIST(reals, 1),
                                    .rows = LIST(rows, 2),
                                    .points = LIST(points, 1),
                                    .few = LIST(few, 2),
                                    .cells = {{-1, 2}, {0, 0, 0, 3}},
                                    .corners = {{0.5, 0.25}, {-0.5, -0.25}},
                                    .switches = {true, false, true},
                                    .code = {'a', 'b', '\0', 'd', 'e'},
                                    .deep = LIST(deep, 1),
                                    .grids = LIST(grids, 1),
                                    .pair = {LIST(NULL, 0), LIST(reals, 1)}};
    return value;
}

static Constructs_Unions UnionsFull(void)
{
    static int32_t list[2] = {1, -1};
    static Constructs_Number numbers[3] = {{._d = 1, ._u = {.real = 0.125}}, {._d = 3}, {._d = 77}};
    strcpy(numbers[1]._u.text, "five5");
    numbers[2]._u.list = (dds_sequence_long)LIST(list, 2);
    Constructs_Unions value = {.val = {._d = Basics_BLUE, ._u = {.point = {1.0, 2.0}}},
                               .num = {._d = -2},
                               .optional_grid = {._d = true, ._u = {.present = {{1, 2, 3, 4}}}},
                               .let = {._d = 'q'},
                               .wid = {._d = 60000, ._u = {.huge = 3}},
                               .nar = {._d = 255, ._u = {.m = Constructs_GONE}},
                               .numbers = LIST(numbers, 3)};
    strcpy(value.num._u.text, "");
    strcpy(value.let._u.quote, "q");
    return value;
}

static Constructs_Derived DerivedFull(void)
{
    static Basics_Stamp history[2] = {{1, 10}, {2, 20}};
    return (Constructs_Derived){.parent = {.parent = {.level = 3}, .weight = 70.5},
                                .name = "derived",
                                .stamp = {4, 40},
                                .history = LIST(history, 2)};
}

static Constructs_Inner_Empty InnerEmpty(void)
{
    return (Constructs_Inner_Empty){.nothing = LIST(NULL, 0)};
}

static Keys_ShortKey ShortKey(void)
{
    static double between[1] = {1.0};
    return (Keys_ShortKey){.before = "b", .a = 1, .between = LIST(between, 1), .b = -2, .c = 3, .after = 4.0};
}

static Keys_BoundedTextKey BoundedTextKey(void)
{
    Keys_BoundedTextKey value = {.value = 1.0};
    strcpy(value.name, &"eleven bytes"[1]);
    return value;
}

static Keys_WideBoundedTextKey WideBoundedTextKey(void)
{
    Keys_WideBoundedTextKey value = {.value = 1.0};
    strcpy(value.name, "x");
    return value;
}

#define RETURN_VALUE(text, c_type, maker)                      \
    if (strcmp(name, text) == 0)                               \
    {                                                          \
        static c_type value;                                   \
        value = maker;                                         \
        return (CycloneValue){.type = &c_type##_desc, &value}; \
    }

// Cyclone DDS copies a type that contains only numbers as a block, including the bytes between them: zeros
// in a static object.
#define RETURN_PLAIN(text, c_type, ...)                        \
    if (strcmp(name, text) == 0)                               \
    {                                                          \
        static c_type value = __VA_ARGS__;                     \
        return (CycloneValue){.type = &c_type##_desc, &value}; \
    }

CycloneValue CycloneValueNamed(const char *name)
{
    RETURN_PLAIN("NumbersExtreme", Constructs_Numbers,
                 {.flag = true,
                  .i64 = INT64_MIN,
                  .letter = '\xff',
                  .real64 = -1.5e-300,
                  .raw = 255,
                  .i16 = INT16_MIN,
                  .i8 = INT8_MIN,
                  .u32 = UINT32_MAX,
                  .u8 = UINT8_MAX,
                  .u64 = UINT64_MAX,
                  .u16 = UINT16_MAX,
                  .real32 = INFINITY,
                  .i32 = INT32_MIN})
    RETURN_VALUE("TextsFull", Constructs_Texts, TextsFull())
    RETURN_VALUE("ChoicesFull", Constructs_Choices, ChoicesFull())
    RETURN_VALUE("CollectionsFull", Constructs_Collections, CollectionsFull())
    RETURN_VALUE("UnionsFull", Constructs_Unions, UnionsFull())
    RETURN_VALUE("DerivedFull", Constructs_Derived, DerivedFull())
    RETURN_VALUE("InnerEmpty", Constructs_Inner_Empty, InnerEmpty())
    RETURN_VALUE("ShortKey", Keys_ShortKey, ShortKey())
    RETURN_PLAIN("ExactKey", Keys_ExactKey, {UINT64_MAX, -2})
    RETURN_PLAIN("LongKey", Keys_LongKey, {1, 2, 3})
    RETURN_PLAIN("TextKey", Keys_TextKey, {1, "name", 2})
    RETURN_VALUE("BoundedTextKey", Keys_BoundedTextKey, BoundedTextKey())
    RETURN_VALUE("WideBoundedTextKey", Keys_WideBoundedTextKey, WideBoundedTextKey())
    RETURN_PLAIN("NestedKey", Keys_NestedKey, {.place = {7, 0.5, 'z'}, .value = 8, .plain = {true, 1.5F}})
    RETURN_PLAIN("ArrayKey", Keys_ArrayKey, {{{1, 2, 3}, {4, 5, 6}}, Keys_K1, 7})
    RETURN_PLAIN("NumberedKey", Keys_NumberedKey, {3, "text", {4, 5}})
    RETURN_PLAIN("DerivedKey", Keys_DerivedKey, {{5, "base"}, 0.5})
    return (CycloneValue){.type = NULL, .value = NULL};
}

#undef RETURN_VALUE
#undef RETURN_PLAIN
#undef LIST
