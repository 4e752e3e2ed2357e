//! Words and signs of a source, without comments, strings and lifetimes.

/// A word, a number, `::` or one sign.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// as written
    pub text: String,
    /// from 1
    pub line: usize,
}

impl Token {
    /// Whether it is a name or keyword.
    pub fn is_word(&self) -> bool {
        self.text
            .starts_with(|c: char| c.is_alphabetic() || c == '_')
    }
}

/// Splits a source.
pub fn tokens(text: &str) -> Vec<Token> {
    let chars: Vec<char> = text.chars().collect();
    let mut reader = Reader {
        chars: &chars,
        at: 0,
        line: 1,
    };
    let mut found = Vec::new();
    while let Some(c) = reader.peek(0) {
        let line = reader.line;
        let mut text = String::new();
        if c == '/' && reader.peek(1) == Some('/') {
            reader.skip_while(|c| c != '\n');
        } else if c == '/' && reader.peek(1) == Some('*') {
            reader.skip_block_comment();
        } else if c == '"' {
            reader.skip_string();
        } else if c == '\'' {
            reader.skip_character_or_lifetime();
        } else if let Some(hashes) = reader.raw_string() {
            reader.skip_raw_string(hashes);
        } else if c.is_alphanumeric() || c == '_' {
            while let Some(c) = reader.peek(0).filter(|c| c.is_alphanumeric() || *c == '_') {
                text.push(c);
                reader.advance();
            }
        } else {
            reader.advance();
            if c == ':' && reader.peek(0) == Some(':') {
                reader.advance();
                text.push_str("::");
            } else if !c.is_whitespace() {
                text.push(c);
            }
        }
        if !text.is_empty() {
            found.push(Token { text, line });
        }
    }
    found
}

struct Reader<'a> {
    chars: &'a [char],
    at: usize,
    line: usize,
}

impl Reader<'_> {
    fn peek(&self, ahead: usize) -> Option<char> {
        self.chars.get(self.at + ahead).copied()
    }

    fn advance(&mut self) {
        self.line += usize::from(self.peek(0) == Some('\n'));
        self.at += 1;
    }

    fn skip_while(&mut self, holds: impl Fn(char) -> bool) {
        while self.peek(0).is_some_and(&holds) {
            self.advance();
        }
    }

    fn skip_block_comment(&mut self) {
        let mut depth = 0;
        while self.peek(0).is_some() {
            match (self.peek(0), self.peek(1)) {
                (Some('/'), Some('*')) => depth += 1,
                (Some('*'), Some('/')) => depth -= 1,
                _ => {
                    self.advance();
                    continue;
                }
            }
            self.advance();
            self.advance();
            if depth == 0 {
                break;
            }
        }
    }

    fn skip_string(&mut self) {
        self.advance();
        while let Some(c) = self.peek(0) {
            self.advance();
            match c {
                '\\' => self.advance(),
                '"' => break,
                _ => {}
            }
        }
    }

    fn skip_character_or_lifetime(&mut self) {
        self.advance();
        if self.peek(0) == Some('\\') {
            self.advance();
            self.advance();
            self.skip_while(|c| c != '\'');
            self.advance();
        } else if self.peek(1) == Some('\'') {
            self.advance();
            self.advance();
        } else {
            self.skip_while(|c| c.is_alphanumeric() || c == '_');
        }
    }

    /// Number of `#` where a raw string (perhaps of bytes) begins here.
    fn raw_string(&self) -> Option<usize> {
        let start = match (self.peek(0)?, self.peek(1)) {
            ('b', Some('r')) => 2,
            ('r', _) => 1,
            _ => return None,
        };
        let hashes = (0..)
            .take_while(|k| self.peek(start + k) == Some('#'))
            .count();
        (self.peek(start + hashes) == Some('"')).then_some(hashes)
    }

    fn skip_raw_string(&mut self, hashes: usize) {
        self.skip_while(|c| c != '"');
        self.advance();
        while self.peek(0).is_some() {
            let closes = self.peek(0) == Some('"')
                && (1..=hashes).all(|ahead| self.peek(ahead) == Some('#'));
            self.advance();
            if closes {
                break;
            }
        }
    }
}
