#include "RandomSample.h"

#include <algorithm>
#include <bit>
#include <limits>
#include <string>

namespace
{

using Rabit::Dynamic::Kind;
using Rabit::Dynamic::Shape;

class Writer
{
public:
    Writer(bool littleEndian, std::mt19937 &random) : _little(littleEndian), _random(random) {}

    std::vector<std::uint8_t> Finish()
    {
        const std::size_t before = _body.size();
        Align(4);
        std::vector<std::uint8_t> sample(4 + _body.size());
        sample[1] = _little ? 1 : 0;
        sample[3] = static_cast<std::uint8_t>(_body.size() - before);
        std::copy(_body.begin(), _body.end(), sample.begin() + 4);
        return sample;
    }

    void Value(const Shape &shape)
    {
        switch (shape.What)
        {
            case Kind::Bool:
                return Put(Below(2), 1);
            case Kind::Float:
                return Put(std::bit_cast<std::uint32_t>(static_cast<float>(Real())), 4);
            case Kind::Double:
                return Put(std::bit_cast<std::uint64_t>(Real()), 8);
            case Kind::String:
                return Text(shape.Bound);
            case Kind::Sequence:
            {
                const std::size_t most = shape.Element->MinSize > 1000 ? 1 : 5;
                const std::size_t length =
                    Below(1 + (shape.Bound == 0 ? most : std::min<std::size_t>(shape.Bound, most)));
                Put(length, 4);
                return List(*shape.Element, length);
            }
            case Kind::Array:
                return List(*shape.Element, shape.Length);
            case Kind::Enum:
                return Put(shape.Names[Below(shape.Names.size())].Number, shape.Size);
            case Kind::Bitmask:
                return Put(Bits() & shape.AllBits, shape.Size);
            case Kind::Struct:
                for (const auto &part : shape.Parts)
                {
                    Value(*part.Type);
                }
                return;
            case Kind::Union:
                return Union(shape);
            default:
                return Put(Bits(), shape.Size);
        }
    }

private:
    std::size_t Below(std::size_t limit) { return _random() % limit; }
    std::uint64_t Bits()
    {
        static constexpr std::uint64_t notable[] = {0,
                                                    1,
                                                    0x7f,
                                                    0x80,
                                                    0x7fff,
                                                    0x8000,
                                                    0x7fffffff,
                                                    0x80000000,
                                                    0x7fffffffffffffff,
                                                    0x8000000000000000,
                                                    ~std::uint64_t{0}};
        const std::uint64_t high = _random();
        return Below(3) == 0 ? notable[Below(std::size(notable))] : high << 32 | _random();
    }
    static constexpr double Infinity = std::numeric_limits<double>::infinity();
    // No NaN: JSON keeps neither its sign nor its payload.
    double Real()
    {
        static constexpr double notable[] = {0.0,     -0.0,       1.0,      -1.5,      1e300,
                                             -1e-300, 4e-45,      Infinity, -Infinity, 18446744073709551616.0,
                                             0.1,     123456789.0};
        const double any = std::bit_cast<double>(Bits());
        return Below(2) == 0 || any != any ? notable[Below(std::size(notable))] : any;
    }
    void Text(std::uint32_t bound)
    {
        static const std::string pieces[] = {
            "a",    "B",        "\n",       "\x1b[2J",      "\"",
            "\\",   "\xc3\xbc", "\xc2\x9b", "\xe2\x82\xac", "\xf0\x9f\x9b\xb0",
            "\xff", "\x7f",     "\xc3"};
        std::string text;
        for (std::size_t i = Below(6); i > 0; --i)
        {
            const std::string &piece = pieces[Below(std::size(pieces))];
            text += bound == 0 || text.size() + piece.size() <= bound ? piece : "";
        }
        Put(text.size() + 1, 4);
        _body.insert(_body.end(), text.begin(), text.end());
        _body.push_back(0);
    }
    void List(const Shape &element, std::size_t count)
    {
        for (std::size_t i = 0; i < count; ++i)
        {
            Value(element);
        }
    }
    void Union(const Shape &shape)
    {
        // A label of a case, or any value.
        std::uint64_t label = Bits();
        if (shape.Discriminator->What == Kind::Enum)
        {
            label = shape.Discriminator->Names[Below(shape.Discriminator->Names.size())].Number;
        }
        else if (shape.Discriminator->What == Kind::Bool)
        {
            label = Below(2);
        }
        const int known = static_cast<int>(Below(shape.Labels.size() + 1));
        if (known < static_cast<int>(shape.Labels.size()) || shape.OtherCase == Rabit::Dynamic::NotAllowed)
        {
            label = static_cast<std::uint64_t>(
                shape.Labels[static_cast<std::size_t>(known) % shape.Labels.size()].first);
        }
        const unsigned size = shape.Discriminator->Size;
        Put(label, size);
        // The label as it is read: cut to its size, with a sign if the type has one.
        std::int64_t read = static_cast<std::int64_t>(label);
        if (size < 8)
        {
            const unsigned gone = 64 - 8 * size;
            const bool hasSign =
                shape.Discriminator->What == Kind::Char || shape.Discriminator->What == Kind::Int8 ||
                shape.Discriminator->What == Kind::Int16 || shape.Discriminator->What == Kind::Int32;
            read = hasSign ? static_cast<std::int64_t>(label << gone) >> gone
                           : static_cast<std::int64_t>(label << gone >> gone);
        }
        const int place = Rabit::Dynamic::CaseOf(shape, read);
        if (place >= 0)
        {
            Value(*shape.Parts[static_cast<std::size_t>(place)].Type);
        }
    }
    void Align(unsigned size) { _body.resize(_body.size() + (size - _body.size() % size) % size); }
    void Put(std::uint64_t bits, unsigned size)
    {
        Align(size);
        for (unsigned i = 0; i < size; ++i)
        {
            _body.push_back(static_cast<std::uint8_t>(bits >> 8 * (_little ? i : size - 1 - i)));
        }
    }

    bool _little;
    std::mt19937 &_random;
    std::vector<std::uint8_t> _body;
};

}  // namespace

std::vector<std::uint8_t> RandomSample(const Shape &root, bool littleEndian, std::mt19937 &random)
{
    Writer writer(littleEndian, random);
    writer.Value(root);
    return writer.Finish();
}
