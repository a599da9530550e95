#include "dynamic/TextGuard.h"

#include "dynamic/IdlTokens.h"
#include "dynamic/Limits.h"
#include "model/Names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace Rabit::Dynamic
{
namespace
{

// Leaves the guard from any depth; caught where it is run.
struct NotGrammatical : std::runtime_error
{
    using std::runtime_error::runtime_error;
};

// Names are the same in either case.
std::string Lower(std::string_view name)
{
    std::string lower(name.substr(name[0] == '_' ? 1 : 0));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return std::tolower(letter); });
    return lower;
}

constexpr std::uint64_t Max32 = std::numeric_limits<std::uint32_t>::max();

// Follows the grammar of IDL (OMG IDL 4.2, 7.4, and XTypes 7.3.1), and builds nothing.
class Guard
{
public:
    explicit Guard(const std::vector<Token> &tokens) : _tokens(tokens) {}

    void Text()
    {
        while (Now().What != Token::Kind::End)
        {
            Definition(0);
        }
    }

private:
    const Token &Now() const { return _tokens[_at]; }

    [[noreturn]] void Refuse(const std::string &reason) const
    {
        throw NotGrammatical("line " + std::to_string(Now().Line) + ": " + reason);
    }
    [[noreturn]] void Expected(const std::string &what) const
    {
        Refuse(
            "expected " + what +
            (Now().What == Token::Kind::End ? ", not the end" : ", not '" + std::string(Now().Text) + "'"));
    }

    bool Is(char sign) const { return Now().What == Token::Kind::Sign && Now().Text[0] == sign; }
    bool IsWord(std::string_view word) const { return Now().What == Token::Kind::Word && Now().Text == word; }
    // An annotation behind a type of that name, seen from there, is what the parser crashes on: it takes the
    // type for it.
    bool IsAnnotation() const
    {
        if (Now().What != Token::Kind::Annotation)
        {
            return false;
        }
        const std::string name = Lower(Now().Text);
        for (const auto &[scope, types] : _types)
        {
            if (_scope.compare(0, scope.size(), scope) == 0 && types.count(name) != 0)
            {
                Refuse("annotation '@" + std::string(Now().Text) + "' behind a type of that name");
            }
        }
        return true;
    }
    bool IsAnnotation(std::string_view name) const
    {
        return Now().What == Token::Kind::Annotation && Now().Text == name;
    }
    // The name of a type that the parser looks up among others.
    void TypeName()
    {
        static const std::set<std::string> annotations{"final", "appendable",      "nested",  "bit_bound",
                                                       "key",   "default",         "id",      "unit",
                                                       "value", "default_literal", "position"};
        const std::string name = Lower(Now().Text);
        if (annotations.count(name) != 0)
        {
            _types[_scope].insert(name);
        }
        Name();
    }
    void Sign(char sign)
    {
        if (!Is(sign))
        {
            Expected("'" + std::string(1, sign) + "'");
        }
        ++_at;
    }
    bool TakeWord(std::string_view word)
    {
        const bool is = IsWord(word);
        _at += is ? 1 : 0;
        return is;
    }

    void Count(std::size_t &count, std::size_t most, const char *what)
    {
        if (++count > most)
        {
            Refuse("more than " + std::to_string(most) + " " + what);
        }
    }

    // A name that is declared, or a part of one: no word of IDL, unless an underscore stands before it.
    void Name()
    {
        if (Now().What != Token::Kind::Word)
        {
            Expected("a name");
        }
        const std::string name(Now().Text);
        const bool isEscaped = name[0] == '_';
        const char first = name.size() > (isEscaped ? 1U : 0U) ? name[isEscaped ? 1 : 0] : '_';
        if ((!isEscaped && RabitIdl::IsIdlKeyword(name)) || first == '_' || (first >= '0' && first <= '9'))
        {
            Expected("a name");
        }
        ++_at;
    }
    void ScopedName()
    {
        if (Now().What == Token::Kind::Scope)
        {
            ++_at;
        }
        Name();
        while (Now().What == Token::Kind::Scope)
        {
            ++_at;
            Name();
        }
    }
    std::uint64_t Number(std::uint64_t least, std::uint64_t most)
    {
        std::uint64_t value = 0;
        const std::string_view text = Now().Text;
        const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
        if (Now().What != Token::Kind::Integer || result.ec != std::errc() || value < least || value > most)
        {
            Expected("a number from " + std::to_string(least) + " to " + std::to_string(most));
        }
        ++_at;
        return value;
    }

    // A value as a label or @default has it. withTexts: also real numbers and texts.
    void Literal(bool withTexts)
    {
        const Token::Kind kind = Now().What;
        if (kind == Token::Kind::Character ||
            (withTexts && (kind == Token::Kind::Real || kind == Token::Kind::Text)) || IsWord("TRUE") ||
            IsWord("FALSE"))
        {
            ++_at;
        }
        else if (Is('-'))
        {
            ++_at;
            if (withTexts && Now().What == Token::Kind::Real)
            {
                ++_at;
                return;
            }
            Number(0, std::uint64_t{1} << 63);
        }
        else
        {
            Number(0, std::numeric_limits<std::uint64_t>::max());
        }
    }

    void Definition(std::size_t depth)
    {
        Count(_definitions, MaxDefinitions, "definitions");
        if (TakeWord("module"))
        {
            if (depth == MaxBrackets)
            {
                Refuse("more than " + std::to_string(MaxBrackets) + " modules within each other");
            }
            const std::size_t outside = _scope.size();
            _scope += "::" + Lower(Now().Text);
            Name();
            Sign('{');
            do
            {
                Definition(depth + 1);
            } while (!Is('}'));
            _scope.resize(outside);
        }
        else if (TakeWord("typedef"))
        {
            Type(0);
            Declarator();
            Sign(';');
            return;
        }
        else
        {
            Annotated();
        }
        Sign('}');
        Sign(';');
    }

    void Annotated()
    {
        const std::size_t first = _at;
        bool isStructured = false;  // has what only a struct or union may have
        bool isNested = false;
        bool hasBound = false;
        while (IsAnnotation())
        {
            if (IsAnnotation("final") || IsAnnotation("appendable"))
            {
                isStructured = isStructured || IsAnnotation("final");
                ++_at;
            }
            else if (IsAnnotation("nested"))
            {
                isNested = true;
                ++_at;
            }
            else if (IsAnnotation("bit_bound"))
            {
                hasBound = true;
                ++_at;
                Sign('(');
                Number(1, 64);
                Sign(')');
            }
            else
            {
                Refuse("annotation '@" + std::string(Now().Text) + "' is not supported here");
            }
            if (_at - first > 12)
            {
                Refuse("too many annotations");
            }
        }
        if (TakeWord("struct"))
        {
            CheckAnnotations(!hasBound);
            Struct();
        }
        else if (TakeWord("union"))
        {
            CheckAnnotations(!hasBound);
            Union();
        }
        else if (TakeWord("enum"))
        {
            CheckAnnotations(!isStructured && !isNested);
            Enum();
        }
        else if (TakeWord("bitmask"))
        {
            CheckAnnotations(!isStructured && !isNested);
            Bitmask();
        }
        else
        {
            Expected("a definition");
        }
    }

    void CheckAnnotations(bool good)
    {
        if (!good)
        {
            Refuse("an annotation does not belong here");
        }
    }

    void Type(std::size_t depth)
    {
        static constexpr std::array<std::string_view, 14> single{
            "boolean", "char",   "octet", "int8",   "uint8", "int16", "uint16",
            "int32",   "uint32", "int64", "uint64", "short", "float", "double"};
        if (depth == MaxBrackets)
        {
            Refuse("more than " + std::to_string(MaxBrackets) + " types within each other");
        }
        if (Now().What == Token::Kind::Word &&
            std::find(single.begin(), single.end(), Now().Text) != single.end())
        {
            ++_at;
        }
        else if (TakeWord("unsigned"))
        {
            if (!TakeWord("short"))
            {
                Long();
            }
        }
        else if (IsWord("long"))
        {
            Long();
        }
        else if (TakeWord("string"))
        {
            if (Is('<'))
            {
                ++_at;
                Number(1, Max32);
                Sign('>');
            }
        }
        else if (TakeWord("sequence"))
        {
            Sign('<');
            Type(depth + 1);
            if (Is(','))
            {
                ++_at;
                Number(1, Max32);
            }
            Sign('>');
        }
        else
        {
            ScopedName();
        }
    }

    void Long()
    {
        if (!TakeWord("long"))
        {
            Expected("'long'");
        }
        TakeWord("long");
    }

    void Declarator()
    {
        Count(_parts, MaxParts, "members, cases, values and bits");
        Name();
        for (std::size_t dimensions = 0; Is('['); ++dimensions)
        {
            if (dimensions == MaxBrackets)
            {
                Refuse("more than " + std::to_string(MaxBrackets) + " dimensions");
            }
            ++_at;
            Number(1, Max32);
            Sign(']');
        }
    }

    void Struct()
    {
        TypeName();
        if (Is(':'))
        {
            ++_at;
            ScopedName();
        }
        Sign('{');
        do
        {
            MemberAnnotations();
            Type(0);
            Declarator();
            Sign(';');
        } while (!Is('}'));
    }

    void MemberAnnotations()
    {
        for (std::size_t count = 0; IsAnnotation(); ++count)
        {
            const bool isKey = IsAnnotation("key");
            const bool isDefault = IsAnnotation("default");
            const bool isId = IsAnnotation("id");
            if ((!isKey && !isDefault && !isId && !IsAnnotation("unit")) || count == 4)
            {
                Refuse("annotation '@" + std::string(Now().Text) + "' is not supported here");
            }
            ++_at;
            if (isKey)
            {
                continue;
            }
            Sign('(');
            if (isDefault)
            {
                Literal(true);
            }
            else if (isId)
            {
                Number(0, Max32);
            }
            else if (Now().What == Token::Kind::Text)
            {
                ++_at;
            }
            else
            {
                Expected("a text");
            }
            Sign(')');
        }
    }

    void Union()
    {
        TypeName();
        if (!TakeWord("switch"))
        {
            Expected("'switch'");
        }
        Sign('(');
        Type(0);
        Sign(')');
        Sign('{');
        do
        {
            Labels();
            Type(0);
            Declarator();
            Sign(';');
        } while (!Is('}'));
    }

    void Labels()
    {
        if (!IsWord("case") && !IsWord("default"))
        {
            Expected("'case' or 'default'");
        }
        while (IsWord("case") || IsWord("default"))
        {
            Count(_parts, MaxParts, "members, cases, values and bits");
            if (!TakeWord("default"))
            {
                ++_at;
                const bool isName = Now().What == Token::Kind::Scope ||
                                    (Now().What == Token::Kind::Word && !IsWord("TRUE") && !IsWord("FALSE"));
                isName ? ScopedName() : Literal(false);
            }
            Sign(':');
        }
    }

    void Enum()
    {
        TypeName();
        Sign('{');
        while (true)
        {
            for (std::size_t count = 0; IsAnnotation(); ++count)
            {
                if ((!IsAnnotation("value") && !IsAnnotation("default_literal")) || count == 2)
                {
                    Refuse("annotation '@" + std::string(Now().Text) + "' is not supported here");
                }
                const bool isValue = IsAnnotation("value");
                ++_at;
                if (isValue)
                {
                    Sign('(');
                    Number(0, Max32);
                    Sign(')');
                }
            }
            Count(_parts, MaxParts, "members, cases, values and bits");
            Name();
            if (!Is(','))
            {
                return;
            }
            ++_at;
        }
    }

    void Bitmask()
    {
        TypeName();
        Sign('{');
        while (true)
        {
            if (IsAnnotation())
            {
                if (!IsAnnotation("position"))
                {
                    Refuse("annotation '@" + std::string(Now().Text) + "' is not supported here");
                }
                ++_at;
                Sign('(');
                Number(0, 63);
                Sign(')');
            }
            Count(_parts, MaxParts, "members, cases, values and bits");
            Name();
            if (!Is(','))
            {
                return;
            }
            ++_at;
        }
    }

    const std::vector<Token> &_tokens;  // the last one is End
    std::size_t _at = 0;
    std::size_t _definitions = 0;
    std::size_t _parts = 0;
    std::string _scope;  // the modules around, `::a::b`
    std::map<std::string, std::set<std::string>>
        _types;  // by scope; those that have the name of an annotation
};

}  // namespace

std::string WhyNotParsed(std::string_view idlText)
{
    std::string reason;
    const std::vector<Token> tokens = TokensOf(idlText, reason);
    if (!reason.empty())
    {
        return reason;
    }
    try
    {
        Guard(tokens).Text();
        return "";
    }
    catch (const NotGrammatical &error)
    {
        return error.what();
    }
}

}  // namespace Rabit::Dynamic
