// A sink of a walk that writes the value as text for people, like the generated ToString.
#pragma once

#include <rabit/dynamic/Shape.h>

#include <rabit/idl/TextWriter.h>

#include <span>
#include <string_view>

namespace Rabit::Dynamic
{

class TextSink
{
public:
    // If the text exceeds maxSize, Ok() is false.
    TextSink(Idl::TextWriter &out, std::size_t maxSize) : _out(out), _maxSize(maxSize) {}

    void Bool(bool value) { Put(value); }
    void Char(char value) { Put(value); }
    template <class T>
    void Number(T value)
    {
        Put(value);
    }
    void Text(std::string_view text) { Put(text); }
    void Enumerator(const Shape &, const NamedNumber &value) { Raw(value.Name); }
    void Bits(const Shape &shape, std::uint64_t mask)
    {
        const char *separator = "";
        for (const NamedNumber &bit : shape.Names)
        {
            if ((mask & bit.Number) != 0)
            {
                Raw(separator);
                Raw(bit.Name);
                separator = "|";
            }
        }
        if (mask == 0)
        {
            Raw("0");
        }
    }
    void Octets(std::span<const std::uint8_t> bytes, bool isSequence)
    {
        BeginList(bytes.size(), isSequence);
        const std::size_t told = std::min(bytes.size(), Idl::TextWriter::ShownElements + 1);
        for (std::size_t i = 0; i < told; ++i)
        {
            Element(i);
            Put(bytes[i]);
        }
        EndList();
    }
    void BeginList(std::size_t count, bool)
    {
        _lists.push_back({count, _hidden});
        Raw("[");
    }
    void Element(std::size_t index)
    {
        const List &list = _lists.back();
        if (index < Idl::TextWriter::ShownElements)
        {
            Raw(index == 0 ? "" : ", ");
        }
        else if (index == Idl::TextWriter::ShownElements)
        {
            Raw(", ... ");
            Put(list.Count - Idl::TextWriter::ShownElements);
            Raw(" more");
            _hidden = true;
        }
    }
    void EndList()
    {
        _hidden = _lists.back().WasHidden;
        _lists.pop_back();
        Raw("]");
    }
    void BeginStruct() {}
    int Enter(const Shape &shape, std::size_t index)
    {
        Raw(index == 0 ? "{" : ", ");
        Raw(shape.Parts[index].Name);
        Raw(": ");
        return 0;
    }
    void Leave(int) {}
    void EndStruct() { Raw("}"); }
    void BeginUnion(const Shape &shape, std::int64_t, int place)
    {
        Raw("{");
        if (place != NoCase)
        {
            Raw(shape.Parts[static_cast<std::size_t>(place)].Name);
            Raw(": ");
        }
    }
    void EndUnion() { Raw("}"); }
    bool Ok() const { return _out.Text().size() <= _maxSize; }

private:
    struct List
    {
        std::size_t Count;
        bool WasHidden;
    };

    void Raw(std::string_view text)
    {
        if (!_hidden)
        {
            _out.Raw(text);
        }
    }
    template <class T>
    void Put(T value)
    {
        if (!_hidden)
        {
            _out.Put(value);
        }
    }

    Idl::TextWriter &_out;
    std::size_t _maxSize;
    std::vector<List> _lists;
    bool _hidden = false;  // past the shown elements of a list
};

}  // namespace Rabit::Dynamic
