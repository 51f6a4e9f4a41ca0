//! From the text of an expression to its parts: precedence climbing, each mistake with its column.
//!
//! Lowest first: comparisons, + and -, * and /, a sign, and ^, which is taken from the right: -x^2 is -(x^2).

use std::fmt;

use super::error::FormulaError;
use super::function::{Function, NAMED};
use super::node::{Definitions, Node};
use crate::text::nearest::nearest;

/// What expressions depend on.
pub const VARIABLES: [&str; 4] = ["x", "y", "z", "t"];

/// Numbers with a name.
pub const CONSTANTS: [(&str, f64); 2] = [("pi", std::f64::consts::PI), ("e", std::f64::consts::E)];

/// Parts within parts, beyond which an expression is refused rather than the stack overflows.
const DEEPEST: usize = 100;

/// What names in an expression may stand for.
#[derive(Debug, Clone, Copy)]
pub enum Known<'a> {
    /// Coordinates and the time.
    Place {
        /// How many coordinates there are.
        dimensions: usize,
    },
    /// The part s of a midline, which stands for x, and the time.
    Midline,
    /// Variables, whose names are in brackets.
    Names(&'a [String]),
}

/// A token, and the character at which it begins, from 1.
#[derive(Debug, Clone, PartialEq)]
struct Placed {
    token: Token,
    column: usize,
}

/// A token at the beginning of a text, and its characters.
struct Leading {
    token: Token,
    length: usize,
}

/// An operator of a level of precedence.
struct Operator {
    sign: &'static str,
    function: Function,
}

const fn operator(sign: &'static str, function: Function) -> Operator {
    Operator { sign, function }
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Name(String),
    /// What is in brackets.
    Bracketed(String),
    Sign(&'static str),
    End,
}

impl fmt::Display for Token {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Number(value) => write!(formatter, "`{value}`"),
            Self::Name(name) | Self::Bracketed(name) => write!(formatter, "`{name}`"),
            Self::Sign(sign) => write!(formatter, "`{sign}`"),
            Self::End => formatter.write_str("the end of the expression"),
        }
    }
}

/// Signs, longer ones first.
const SIGNS: [&str; 12] = ["<=", ">=", "<", ">", "+", "-", "*", "/", "^", "(", ")", ","];

fn tokens(text: &str, known: Known<'_>) -> Result<Vec<Placed>, FormulaError> {
    let characters: Vec<char> = text.chars().collect();
    let mut tokens = Vec::new();
    let mut at = 0;
    while let Some(&first) = characters.get(at) {
        if first.is_whitespace() {
            at += 1;
            continue;
        }
        let rest = &characters[at..];
        let Leading { token, length } = if first.is_ascii_digit() || first == '.' {
            number(rest, at)?
        } else if first.is_ascii_alphabetic() || first == '_' {
            let is_in = |c: &&char| c.is_ascii_alphanumeric() || **c == '_';
            let name: String = rest.iter().take_while(is_in).collect();
            let length = name.len();
            Leading { token: Token::Name(name), length }
        } else if first == '[' && matches!(known, Known::Names(_)) {
            bracketed(rest, characters.len() + 1)?
        } else {
            let begins =
                |sign: &&str| sign.chars().zip(rest).filter(|(a, b)| a == *b).count() == sign.len();
            let sign = SIGNS.iter().copied().find(|sign| begins(sign)).ok_or_else(|| {
                let found = format!("`{first}`");
                let accepted = "accepted: numbers, names, + - * / ^ < > <= >= ( ) ,".to_owned();
                FormulaError { column: at + 1, found, accepted }
            })?;
            Leading { token: Token::Sign(sign), length: sign.len() }
        };
        tokens.push(Placed { token, column: at + 1 });
        at += length;
    }
    tokens.push(Placed { token: Token::End, column: characters.len() + 1 });
    Ok(tokens)
}

/// The name in brackets that a text begins with; `end` is the column behind the whole text.
fn bracketed(rest: &[char], end: usize) -> Result<Leading, FormulaError> {
    let Some(length) = rest.iter().position(|c| *c == ']') else {
        let found = Token::End.to_string();
        return Err(refuse(end, found, "`]` is expected behind a name in brackets"));
    };
    let name: String = rest[1..length].iter().collect();
    Ok(Leading { token: Token::Bracketed(name.trim().to_owned()), length: length + 1 })
}

/// The number that a text begins with, and its length.
fn number(rest: &[char], at: usize) -> Result<Leading, FormulaError> {
    let mut length = 0;
    while let Some(&c) = rest.get(length) {
        let before = length.checked_sub(1).map(|before| rest[before]);
        let follows =
            rest.get(length + 1).is_some_and(|next| next.is_ascii_digit() || "+-".contains(*next));
        let is_exponent = matches!(c, 'e' | 'E') && follows;
        let is_sign = matches!(c, '+' | '-') && matches!(before, Some('e' | 'E'));
        if !(c.is_ascii_digit() || c == '.' || is_exponent || is_sign) {
            break;
        }
        length += 1;
    }
    let text: String = rest[..length].iter().collect();
    match text.parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(Leading { token: Token::Number(value), length }),
        _ => Err(FormulaError {
            column: at + 1,
            found: format!("`{text}` is no number"),
            accepted: "write 1.5 or 2e-3".to_owned(),
        }),
    }
}

/// The parts of an expression.
///
/// # Errors
/// Where something is not understood.
pub fn parse(
    text: &str,
    definitions: &Definitions,
    known: Known<'_>,
) -> Result<Node, FormulaError> {
    let mut parser = Parser { tokens: tokens(text, known)?, at: 0, depth: 0, definitions, known };
    let root = parser.comparison()?;
    match parser.next() {
        Placed { token: Token::End, .. } => Ok(root),
        Placed { token, column } => {
            Err(refuse(column, token.to_string(), "an operator is expected here"))
        }
    }
}

fn refuse(column: usize, found: String, accepted: &str) -> FormulaError {
    FormulaError { column, found, accepted: accepted.to_owned() }
}

struct Parser<'a> {
    tokens: Vec<Placed>,
    at: usize,
    depth: usize,
    definitions: &'a Definitions,
    known: Known<'a>,
}

impl Parser<'_> {
    fn peek(&self) -> &Token {
        self.tokens.get(self.at).map_or(&Token::End, |next| &next.token)
    }

    /// The next token, with its column; the end again and again.
    fn next(&mut self) -> Placed {
        let last = self.tokens.len() - 1;
        let token = self.tokens[self.at.min(last)].clone();
        self.at += 1;
        token
    }

    /// Takes a sign if it is the next one.
    fn takes(&mut self, sign: &str) -> bool {
        let is_next = matches!(self.peek(), Token::Sign(next) if *next == sign);
        self.at += usize::from(is_next);
        is_next
    }

    /// One of these operators, if it is the next token.
    fn operator(&mut self, known: &[Operator]) -> Option<Function> {
        known.iter().find(|one| self.takes(one.sign)).map(|one| one.function)
    }

    fn comparison(&mut self) -> Result<Node, FormulaError> {
        let left = self.sum()?;
        let known = [
            operator("<=", Function::AtMost),
            operator(">=", Function::AtLeast),
            operator("<", Function::Below),
            operator(">", Function::Above),
        ];
        let Some(function) = self.operator(&known) else { return Ok(left) };
        Ok(Node::Call(function, vec![left, self.sum()?]))
    }

    fn sum(&mut self) -> Result<Node, FormulaError> {
        let mut left = self.product()?;
        while let Some(function) =
            self.operator(&[operator("+", Function::Plus), operator("-", Function::Minus)])
        {
            left = Node::Call(function, vec![left, self.product()?]);
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Node, FormulaError> {
        let mut left = self.signed()?;
        while let Some(function) =
            self.operator(&[operator("*", Function::Times), operator("/", Function::Over)])
        {
            left = Node::Call(function, vec![left, self.signed()?]);
        }
        Ok(left)
    }

    fn signed(&mut self) -> Result<Node, FormulaError> {
        self.deeper()?;
        let node = if self.takes("-") {
            Node::Call(Function::Negative, vec![self.signed()?])
        } else if self.takes("+") {
            self.signed()?
        } else {
            self.power()?
        };
        self.depth -= 1;
        Ok(node)
    }

    fn power(&mut self) -> Result<Node, FormulaError> {
        let base = self.operand()?;
        if !self.takes("^") {
            return Ok(base);
        }
        Ok(Node::Call(Function::Power, vec![base, self.signed()?]))
    }

    fn deeper(&mut self) -> Result<(), FormulaError> {
        self.depth += 1;
        if self.depth <= DEEPEST {
            return Ok(());
        }
        let column = self.tokens.get(self.at).map_or(1, |next| next.column);
        Err(refuse(column, format!("more than {DEEPEST} parts within parts"), "write less"))
    }

    fn operand(&mut self) -> Result<Node, FormulaError> {
        match self.next() {
            Placed { token: Token::Number(value), .. } => Ok(Node::Number(value)),
            Placed { token: Token::Name(name), column } => self.named(&name, column),
            Placed { token: Token::Bracketed(name), column } => {
                let variable = self.variable(&name, column)?;
                variable.ok_or_else(|| self.unknown(&name, column))
            }
            Placed { token: Token::Sign("("), .. } => {
                let inside = self.comparison()?;
                self.close()?;
                Ok(inside)
            }
            Placed { token, column } => {
                let accepted = if matches!(token, Token::Sign("*")) {
                    "a number, a name or ( is expected here; a power is written x^2"
                } else {
                    "a number, a name or ( is expected here"
                };
                Err(refuse(column, token.to_string(), accepted))
            }
        }
    }

    fn close(&mut self) -> Result<(), FormulaError> {
        if self.takes(")") {
            return Ok(());
        }
        let Placed { token, column } = self.next();
        Err(refuse(column, token.to_string(), "`)` or an operator is expected here"))
    }

    fn named(&mut self, name: &str, column: usize) -> Result<Node, FormulaError> {
        if let Some(function) = Function::named(name) {
            return self.call(name, column, function);
        }
        if let Some(variable) = self.variable(name, column)? {
            return Ok(variable);
        }
        if let Some((_, value)) = CONSTANTS.iter().find(|(known, _)| *known == name) {
            return Ok(Node::Number(*value));
        }
        if let Some(value) = self.definitions.get(name) {
            return Ok(Node::Number(*value));
        }
        Err(self.unknown(name, column))
    }

    /// The variable of a name, if there is one.
    fn variable(&self, name: &str, column: usize) -> Result<Option<Node>, FormulaError> {
        let which = match self.known {
            Known::Place { dimensions } => {
                let which = VARIABLES.iter().position(|known| *known == name);
                if which == Some(2) && dimensions < 3 {
                    let accepted = "x and y are the coordinates in the plane";
                    return Err(refuse(column, "there is no `z`".to_owned(), accepted));
                }
                which
            }
            Known::Midline => VARIABLES.iter().position(|known| match name {
                "s" => *known == "x",
                _ => name == "t" && *known == "t",
            }),
            Known::Names(names) => names.iter().position(|known| known == name),
        };
        Ok(which.map(Node::Variable))
    }

    fn unknown(&self, name: &str, column: usize) -> FormulaError {
        let functions = NAMED.iter().map(|(name, _)| *name);
        let own = self.definitions.keys().map(String::as_str);
        let found = format!("there is no `{name}`");
        let of_place = |variables: &[&'static str]| {
            let variables = variables.iter().copied().chain(["t", "pi", "e"]);
            let known: Vec<&str> = own.clone().chain(variables).chain(functions.clone()).collect();
            let near = nearest(name, &known);
            let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
            format!("{near}known: {}; numbers get names in [define]", known.join(", "))
        };
        let accepted = match self.known {
            Known::Place { dimensions } => of_place(&VARIABLES[..dimensions]),
            Known::Midline => of_place(&["s"]),
            Known::Names(names) => {
                let names = names.iter().map(String::as_str);
                let known: Vec<&str> =
                    own.clone().chain(names).chain(["pi", "e"]).chain(functions.clone()).collect();
                let near = nearest(name, &known);
                let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
                format!(
                    "{near}known in brackets: quantities as series.csv has them, time, target.NAME, action.COMMAND \
                     and names of [environment.value]"
                )
            }
        };
        FormulaError { column, found, accepted }
    }

    fn call(
        &mut self,
        name: &str,
        column: usize,
        function: Function,
    ) -> Result<Node, FormulaError> {
        if !self.takes("(") {
            let Placed { token, column } = self.next();
            let accepted = format!("write {name}(...)");
            return Err(FormulaError { column, found: token.to_string(), accepted });
        }
        let mut parts = vec![self.comparison()?];
        while self.takes(",") {
            parts.push(self.comparison()?);
        }
        self.close()?;
        let [least, most] = function.arguments();
        if (least..=most).contains(&parts.len()) {
            return Ok(Node::Call(function, parts));
        }
        let plural = if least == 1 { "" } else { "s" };
        let more = if most > least { " or more" } else { "" };
        let found = format!("`{name}` has {} of its {least}{more} argument{plural}", parts.len());
        Err(refuse(column, found, "separate them by commas"))
    }
}
