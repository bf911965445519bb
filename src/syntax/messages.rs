//! Words of problems, and what they are made of.

/// What stands at some place, in a message: on one line, and not too long.
pub fn shorten(written: &str) -> String {
    const LONGEST: usize = 40;
    let mut short = String::new();
    for (index, word) in written.split_whitespace().enumerate() {
        if index > 0 {
            short.push(' ');
        }
        short.extend(word.chars().take(LONGEST + 1));
        if short.chars().count() > LONGEST {
            let mut cut: String = short.chars().take(LONGEST).collect();
            cut.push('…');
            return cut;
        }
    }
    short
}

/// What a character that cannot be seen is called.
pub fn name_of_space(text: &str) -> String {
    let character = text.chars().next().unwrap_or_default();
    let name = match character {
        '\0' => "a NUL",
        '\u{A0}' => "a no-break space",
        '\u{202F}' => "a narrow no-break space",
        '\u{200B}' => "a zero-width space",
        '\u{200C}' => "a zero-width non-joiner",
        '\u{200D}' => "a zero-width joiner",
        '\u{FEFF}' => "a byte order mark",
        '\u{3000}' => "an ideographic space",
        c if c.is_whitespace() => "a space",
        _ => "a control character",
    };
    format!("U+{:04X}, {name},", u32::from(character))
}

/// How many metres a unit of length is.
pub fn metres(unit: &str) -> Option<f64> {
    Some(match unit.to_ascii_lowercase().as_str() {
        "m" | "metre" | "metres" | "meter" | "meters" | "px" | "pixel" | "pixels" => 1.0,
        "cm" => 0.01,
        "mm" => 0.001,
        "km" => 1000.0,
        "ft" | "feet" | "foot" => 0.3048,
        "in" | "inch" | "inches" => 0.0254,
        _ => return None,
    })
}

/// How a unit of angles is written here, and how many of that it is.
pub fn angle_unit(unit: &str) -> Option<(f64, &'static str)> {
    Some(match unit.to_ascii_lowercase().as_str() {
        "°" | "deg" | "d" | "de" | "dge" | "degs" | "degree" | "degrees" => (1.0, "deg"),
        "rad" | "ra" | "rda" | "rads" | "radian" | "radians" => (1.0, "rad"),
        "grad" | "grads" | "gon" => (0.9, "deg"),
        _ => return None,
    })
}

/// A number times a factor, without the last digits, which are those of rounding.
pub fn scaled(number: &str, factor: f64) -> Option<String> {
    let written = number.replace('_', "");
    if factor == 1.0 {
        return Some(number.to_owned());
    }
    let value = written.parse::<f64>().ok()? * factor;
    let digits = format!("{value:.11e}");
    let rounded: f64 = digits.parse().ok()?;
    Some(format!("{rounded}"))
}

/// What other languages say that this one does not: the words that start it, what it is, and what to do instead.
pub fn foreign_statement(word: &str) -> Option<(&'static str, &'static str)> {
    Some(match word {
        "if" | "else" | "switch" | "case" => (
            "conditions",
            "write what holds; `min` and `max` choose between two numbers",
        ),
        "for" | "while" | "loop" | "repeat" | "foreach" => (
            "loops",
            "write each object by itself, or write the file by a program",
        ),
        "import" | "include" | "require" | "use" | "#include" => (
            "including of other files",
            "write all of a scene into one file",
        ),
        "#version" | "#declare" | "#local" | "#macro" | "#define" | "#if" | "#end" => (
            "directives",
            "name a value with `let NAME = VALUE`; a comment begins with `//`",
        ),
        "print" | "echo" | "printf" | "console" => (
            "output",
            "take it away; `pinhole inspect` shows what a scene's values are",
        ),
        "function" | "fn" | "def" | "fun" | "lambda" | "return" | "class" | "struct" => (
            "functions of one's own",
            "give each result a name with `let NAME = VALUE`",
        ),
        _ => return None,
    })
}

/// The kind of file that a text looks like which is no scene at all.
pub fn foreign_file(text: &str) -> Option<&'static str> {
    const ENOUGH: usize = 1 << 14;
    let text = text.trim_start_matches('\u{feff}').trim_start();
    let end = (0..=ENOUGH.min(text.len()))
        .rev()
        .find(|&end| text.is_char_boundary(end));
    let text = text.get(..end?)?;
    let lines = || text.lines().map(str::trim_start);
    let starting = |words: &[&str]| {
        let lines = lines().filter(|line| words.iter().any(|word| line.starts_with(word)));
        lines.count()
    };
    let tight: String = text
        .chars()
        .filter(|c| !c.is_whitespace())
        .take(64)
        .collect();
    if tight.starts_with("<?xml") || (tight.starts_with('<') && text.contains("</")) {
        return Some("XML");
    }
    if tight.starts_with("{\"") || tight.starts_with("[{") || tight.starts_with("[\"") {
        return Some("JSON");
    }
    let pov = [
        "light_source",
        "#declare",
        "#version",
        "#include",
        "pigment",
        "global_settings",
    ];
    let angular = text.matches("location <").count() + text.matches("look_at <").count();
    if starting(&pov) + angular > 2 {
        return Some("a scene of POV-Ray");
    }
    let pbrt = [
        "LookAt ",
        "Camera \"",
        "WorldBegin",
        "Shape \"",
        "Film \"",
        "Integrator \"",
        "Sampler \"",
        "AttributeBegin",
    ];
    if starting(&pbrt) > 1 {
        return Some("a scene of pbrt");
    }
    let keys = lines().filter(|line| {
        let key = line
            .split(':')
            .next()
            .unwrap_or_default()
            .trim_start_matches("- ");
        line.contains(':')
            && !key.is_empty()
            && key.bytes().all(|b| b.is_ascii_alphanumeric() || b == b'_')
    });
    let (keys, all) = (
        keys.count(),
        lines().filter(|line| !line.is_empty()).count(),
    );
    (keys > 2 && keys * 3 >= all * 2 && !text.contains(['{', '='])).then_some("YAML")
}
