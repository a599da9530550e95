// Whether what the stock reader made of a sample is the value that our JSON of it says.

// JSON in which integers that a double cannot hold stay exact.
export function parseExact(text) {
    const marked = text.replace(/"(?:[^"\\]|\\.)*"|-?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?/g, (token) =>
        /^-?\d{16,}$/.test(token) ? `{"exact":"${token}"}` : token);
    return JSON.parse(marked);
}

// Returns an empty text, or the path at which they differ. `definitions` are those of omgidl-parser, by name.
export function difference(expected, got, field, definitions, path = "") {
    const differs = () => `${path}: ${JSON.stringify(expected)} is read as ${String(got)}`;
    if (Array.isArray(expected)) {
        if (got === undefined || got.length !== expected.length) return differs();
        for (let at = 0; at < expected.length; ++at) {
            const inner = difference(expected[at], got[at], field, definitions, `${path}[${at}]`);
            if (inner !== "") return inner;
        }
        return "";
    }
    if (expected !== null && typeof expected === "object") {
        if ("exact" in expected) return BigInt(expected.exact) === BigInt(got) ? "" : differs();
        if ("base64" in expected && typeof got === "string") {
            return new TextDecoder().decode(Buffer.from(expected.base64, "base64")) === got ? "" : differs();
        }
        // What escapes a word of IDL stays part of the name over there.
        const nameOf = (name) => name.replace(/^_/, "");
        const members = Object.keys(expected).filter((name) => name !== "_d");
        if (got === undefined || String(Object.keys(got).map(nameOf)) !== String(members)) return differs();
        const definition = definitions.get(field.type);
        const fields = definition.aggregatedKind === "union"
            ? [...definition.cases.map((one) => one.type), ...(definition.defaultCase ? [definition.defaultCase] : [])]
            : definition.definitions;
        for (const name of members) {
            const member = fields.find((one) => nameOf(one.name) === name);
            const inner = difference(expected[name], got[member.name], member, definitions, `${path}.${name}`);
            if (inner !== "") return inner;
        }
        return "";
    }
    if (typeof expected === "string") return sameText(expected, got, field, definitions) ? "" : differs();
    if (typeof expected === "number" && field.type === "float32") return Math.fround(expected) === got ? "" : differs();
    if (typeof expected === "number") return expected === Number(got) ? "" : differs();
    return expected === got ? "" : differs();
}

function sameText(expected, got, field, definitions) {
    if (typeof got === "string") return expected === got;
    if (got instanceof Uint8Array) return Buffer.from(got).toString("base64") === expected;
    if (field.enumType !== undefined) {
        const value = definitions.get(field.enumType).definitions.find((one) => one.name === expected);
        return value !== undefined && value.value === got;
    }
    if (field.type === "float32" || field.type === "float64") return String(got) === expected;
    return expected.length === 1 && expected.charCodeAt(0) === (got & 0xff);  // a char
}
