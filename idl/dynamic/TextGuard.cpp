#include "dynamic/TextGuard.h"

#include "dynamic/Limits.h"
#include "dynamic/TokenCursor.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <limits>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace Rabit::Dynamic
{
namespace
{

// Names are the same in either case.
std::string Lower(std::string_view name)
{
    std::string lower(name.substr(name.starts_with('_') ? 1 : 0));
    std::transform(lower.begin(), lower.end(), lower.begin(),
                   [](unsigned char letter) { return std::tolower(letter); });
    return lower;
}

constexpr std::uint64_t Max32 = std::numeric_limits<std::uint32_t>::max();

// Checks the grammar of IDL (OMG IDL 4.2, 7.4, and XTypes 7.3.1) without building a tree.
class Guard : private TokenCursor
{
public:
    using TokenCursor::TokenCursor;

    void Text()
    {
        while (Now().What != Token::Kind::End)
        {
            Definition(0);
        }
    }

private:
    using NamesOfScopes = std::map<std::string, std::set<std::string>>;

    static bool IsOfAnnotation(const std::string &name)
    {
        static const std::set<std::string> annotations{"final", "appendable",      "nested",  "bit_bound",
                                                       "key",   "default",         "id",      "unit",
                                                       "value", "default_literal", "position"};
        return annotations.count(name) != 0;
    }
    // True if the name is visible from the current scope.
    bool IsAmong(const NamesOfScopes &names, const std::string &name) const
    {
        return std::any_of(
            names.begin(), names.end(),
            [&](const auto &of)
            { return _scope.compare(0, of.first.size(), of.first) == 0 && of.second.count(name) != 0; });
    }
    // Reads an annotation. If a type of its name is visible there, the parser takes the type for the
    // annotation and crashes, so that is refused.
    bool IsAnnotation() const
    {
        if (Now().What != Token::Kind::Annotation)
        {
            return false;
        }
        const std::string name = Lower(Now().Text);
        if (IsAmong(_types, name))
        {
            Refuse("annotation '@" + std::string(Now().Text) + "' behind a type of that name");
        }
        if (IsAmong(_alike, name))
        {
            Refuse("annotation '@" + std::string(Now().Text) +
                   "' behind a name that differs from it in case alone");
        }
        return true;
    }
    using TokenCursor::IsAnnotation;
    // Reads a name that is declared. The parser also crashes on a name that differs from an annotation's
    // only in case.
    void Name()
    {
        const std::string name = Lower(Now().Text);
        if (IsOfAnnotation(name) && name != Now().Text)
        {
            _alike[_scope].insert(name);
        }
        TokenCursor::Name();
    }
    // Reads the name of a type, which the parser looks up.
    void TypeName()
    {
        const std::string name = Lower(Now().Text);
        if (IsOfAnnotation(name))
        {
            _types[_scope].insert(name);
        }
        Name();
    }
    void Count(std::size_t &count, std::size_t most, const char *what)
    {
        if (++count > most)
        {
            Refuse("more than " + std::to_string(most) + " " + what);
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
        std::size_t count = 0;
        bool isStructured = false;  // has annotations that only a struct or union may have
        bool isNested = false;
        bool hasBound = false;
        while (IsAnnotation())
        {
            if (IsAnnotation("final") || IsAnnotation("appendable"))
            {
                isStructured = isStructured || IsAnnotation("final");
                Step();
            }
            else if (IsAnnotation("nested"))
            {
                isNested = true;
                Step();
            }
            else if (IsAnnotation("bit_bound"))
            {
                hasBound = true;
                Step();
                Sign('(');
                Number(1, 64);
                Sign(')');
            }
            else
            {
                Refuse("annotation '@" + std::string(Now().Text) + "' is not supported here");
            }
            if (++count > 3)
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
            Step();
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
                Step();
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
                Step();
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
            Step();
            Number(1, Max32);
            Sign(']');
        }
    }

    void Struct()
    {
        TypeName();
        if (Is(':'))
        {
            Step();
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
            Step();
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
                Step();
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
                Step();
                const bool isName = Now().What == Token::Kind::Scope ||
                                    (Now().What == Token::Kind::Word && !IsWord("TRUE") && !IsWord("FALSE"));
                isName ? ScopedName() : Literal(false);
            }
            Sign(':');
        }
    }

    // Reads the name of a value or bit. True if another one follows.
    bool NamedPart()
    {
        Count(_parts, MaxParts, "members, cases, values and bits");
        Name();
        const bool another = Is(',');
        if (another)
        {
            Step();
        }
        return another;
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
                Step();
                if (isValue)
                {
                    Sign('(');
                    Number(0, Max32);
                    Sign(')');
                }
            }
            if (!NamedPart())
            {
                return;
            }
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
                Step();
                Sign('(');
                Number(0, 63);
                Sign(')');
            }
            if (!NamedPart())
            {
                return;
            }
        }
    }

    std::size_t _definitions = 0;
    std::size_t _parts = 0;
    std::string _scope;    // the modules around, `::a::b`
    NamesOfScopes _types;  // types that have the name of an annotation
    NamesOfScopes _alike;  // names of annotations that are declared in another case
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
