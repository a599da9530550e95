#pragma once

#include <rabit/idl/CdrReader.h>
#include <rabit/idl/CdrSizer.h>
#include <rabit/idl/CdrWriter.h>
#include <rabit/idl/Codec.h>
#include <rabit/idl/KeyHasher.h>
#include <rabit/idl/TextWriter.h>

#include <algorithm>
#include <array>
#include <string>
#include <vector>

// Codecs for the types that IDL builds in. Each has the members that Codec.h lists, and Value, its C++ type.
// Generated code combines them: `sequence<string<8>, 3>` is List<Text<8>, 3>.
namespace Rabit::Idl
{

// A number, a char or an octet. Neighbours are copied as one block.
template <class T>
struct Scalar
{
    using Value = T;
    static constexpr std::size_t MinSize = sizeof(T);
    static constexpr bool IsBlock = true;
    static bool Write(CdrWriter &writer, T value) { return writer.Put(value); }
    static bool Read(CdrReader &reader, T &value) { return reader.Get(value); }
    static bool Scan(CdrReader &reader, KeyHasher *key)
    {
        T value{};
        if (!reader.Get(value))
        {
            return false;
        }
        if (key != nullptr)
        {
            key->Put(value);
        }
        return true;
    }
    static void Size(CdrSizer &sizer, T) { sizer.Add(sizeof(T)); }
    static void Print(TextWriter &text, T value) { text.Put(value); }
};

struct Boolean
{
    using Value = bool;
    static constexpr std::size_t MinSize = 1;
    static bool Write(CdrWriter &writer, bool value) { return writer.Put(static_cast<std::uint8_t>(value)); }
    static bool Read(CdrReader &reader, bool &value) { return reader.GetBool(value); }
    static bool Scan(CdrReader &reader, KeyHasher *key)
    {
        bool value = false;
        if (!reader.GetBool(value))
        {
            return false;
        }
        if (key != nullptr)
        {
            key->Put(static_cast<std::uint8_t>(value));
        }
        return true;
    }
    static void Size(CdrSizer &sizer, bool) { sizer.Add(1); }
    static void Print(TextWriter &text, bool value) { text.Put(value); }
};

// A string of at most Bound bytes; 0: no bound.
template <std::size_t Bound>
struct Text
{
    using Value = std::string;
    static constexpr std::size_t MinSize = 5;
    static bool Write(CdrWriter &writer, const std::string &value) { return writer.PutString(value, Bound); }
    static bool Read(CdrReader &reader, std::string &value)
    {
        std::string_view view;
        if (!reader.GetString(Bound, view) || !reader.Spend(view.size(), 1))
        {
            return false;
        }
        value.assign(view);
        return true;
    }
    static bool Scan(CdrReader &reader, KeyHasher *key)
    {
        std::string_view view;
        if (!reader.GetString(Bound, view))
        {
            return false;
        }
        if (key != nullptr)
        {
            key->PutString(view);
        }
        return true;
    }
    static void Size(CdrSizer &sizer, const std::string &value) { sizer.AddString(value.size()); }
    static void Print(TextWriter &text, const std::string &value) { text.Put(std::string_view(value)); }
};

// True if adjacent values of a codec may be copied as one block.
template <class Element>
concept IsBlock = requires
{
    requires Element::IsBlock;
};

// Elements one after another, as List and Fixed need them.
template <class Element, class Container>
struct Elements
{
    static bool Write(CdrWriter &writer, const Container &values)
    {
        if constexpr (IsBlock<Element>)
        {
            return writer.PutArray(values.data(), values.size());
        }
        else
        {
            return std::all_of(values.begin(), values.end(),
                               [&](const auto &value) { return Element::Write(writer, value); });
        }
    }
    static bool Read(CdrReader &reader, Container &values)
    {
        if constexpr (IsBlock<Element>)
        {
            return reader.GetArray(values.data(), values.size());
        }
        else
        {
            for (auto &&value : values)
            {
                if constexpr (std::is_same_v<Container, std::vector<bool>>)
                {
                    bool flag = false;
                    if (!Element::Read(reader, flag))
                    {
                        return false;
                    }
                    value = flag;
                }
                else if (!Element::Read(reader, value))
                {
                    return false;
                }
            }
            return true;
        }
    }
    static bool Scan(CdrReader &reader, KeyHasher *key, std::size_t count)
    {
        if constexpr (IsBlock<Element>)
        {
            if (key == nullptr)
            {
                return reader.Skip(Element::MinSize, count);
            }
        }
        for (std::size_t i = 0; i < count; ++i)
        {
            if (!Element::Scan(reader, key))
            {
                return false;
            }
        }
        return true;
    }
    static void Size(CdrSizer &sizer, const Container &values)
    {
        if constexpr (IsBlock<Element>)
        {
            sizer.Add(Element::MinSize, values.size());
        }
        else
        {
            for (const auto &value : values)
            {
                Element::Size(sizer, value);
            }
        }
    }
    static void Print(TextWriter &text, const Container &values)
    {
        text.Raw("[");
        std::size_t shown = 0;
        for (const auto &value : values)
        {
            text.Raw(shown == 0 ? "" : ", ");
            if (shown++ == TextWriter::ShownElements)
            {
                text.Raw("... ");
                text.Put(values.size() - TextWriter::ShownElements);
                text.Raw(" more");
                break;
            }
            Element::Print(text, value);
        }
        text.Raw("]");
    }
};

template <class Element>
struct ValueOf
{
    using Type = typename Element::Value;
};
template <class T>
struct ValueOf<Codec<T>>
{
    using Type = T;
};

// The bytes that a new value allocates: texts of @default.
template <class Element>
constexpr std::size_t FreshSizeOf()
{
    if constexpr (requires { Element::FreshSize; })
    {
        return Element::FreshSize;
    }
    else
    {
        return 0;
    }
}

// Makes a union hold that member, if it does not yet. False if the budget is too small.
template <class Element, std::size_t Index, class Content>
bool Select(CdrReader &reader, Content &content)
{
    if (content.index() != Index)
    {
        if (!reader.Spend(1, sizeof(typename ValueOf<Element>::Type) + FreshSizeOf<Element>()))
        {
            return false;
        }
        content.template emplace<Index>();
    }
    return true;
}

// A sequence of at most Bound elements; 0: no bound.
template <class Element, std::size_t Bound, class Container = std::vector<typename ValueOf<Element>::Type>>
struct List
{
    using Value = Container;
    static constexpr std::size_t MinSize = 4;
    static constexpr std::size_t ElementMemory =
        sizeof(typename Container::value_type) + FreshSizeOf<Element>();
    static bool Write(CdrWriter &writer, const Value &values)
    {
        return (Bound == 0 || values.size() <= Bound) && writer.PutLength(values.size()) &&
               Elements<Element, Value>::Write(writer, values);
    }
    static bool Read(CdrReader &reader, Value &values)
    {
        std::size_t length = 0;
        if (!reader.GetLength(Bound, Element::MinSize, length) || !reader.Spend(length, ElementMemory))
        {
            return false;
        }
        if constexpr (IsBlock<Element> && Element::MinSize == 1)
        {
            // Does not resize first, which would fill a new vector with zeros.
            std::span<const std::uint8_t> bytes;
            if (!reader.GetBytes(length, bytes))
            {
                return false;
            }
            const auto *begin = reinterpret_cast<const typename Value::value_type *>(bytes.data());
            values.assign(begin, begin + length);
            return true;
        }
        else
        {
            if (length > values.capacity())
            {
                values.reserve(length);  // resizing alone might take twice as much
            }
            values.resize(length);
            return Elements<Element, Value>::Read(reader, values);
        }
    }
    static bool Scan(CdrReader &reader, KeyHasher *key)
    {
        std::size_t length = 0;
        return reader.GetLength(Bound, Element::MinSize, length) &&
               Elements<Element, Value>::Scan(reader, key, length);
    }
    static void Size(CdrSizer &sizer, const Value &values)
    {
        sizer.Add(4);
        Elements<Element, Value>::Size(sizer, values);
    }
    static void Print(TextWriter &text, const Value &values)
    {
        Elements<Element, Value>::Print(text, values);
    }
};

// An array.
template <class Element, std::size_t Length>
struct Fixed
{
    using Value = std::array<typename ValueOf<Element>::Type, Length>;
    static constexpr std::size_t MinSize = Length * Element::MinSize;
    static constexpr std::size_t FreshSize = Length * FreshSizeOf<Element>();
    static bool Write(CdrWriter &writer, const Value &values)
    {
        return Elements<Element, Value>::Write(writer, values);
    }
    static bool Read(CdrReader &reader, Value &values)
    {
        return Elements<Element, Value>::Read(reader, values);
    }
    static bool Scan(CdrReader &reader, KeyHasher *key)
    {
        return Elements<Element, Value>::Scan(reader, key, Length);
    }
    static void Size(CdrSizer &sizer, const Value &values) { Elements<Element, Value>::Size(sizer, values); }
    static void Print(TextWriter &text, const Value &values)
    {
        Elements<Element, Value>::Print(text, values);
    }
};

}  // namespace Rabit::Idl
