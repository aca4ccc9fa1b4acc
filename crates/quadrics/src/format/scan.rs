//! Walks through a text: lines, words and numbers, and where they stand.

use super::error;
use crate::error::{Error, Result};

/// A place in a text.
#[derive(Debug, Clone)]
pub(super) struct Scanner<'a> {
    format: &'static str,
    text: &'a [u8],
    pos: usize,
}

impl<'a> Scanner<'a> {
    pub fn new(format: &'static str, text: &'a [u8]) -> Self {
        // Some editors put a byte order mark in front.
        let pos = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { format, text, pos }
    }

    pub fn position(&self) -> usize {
        self.pos
    }

    pub fn remaining(&self) -> usize {
        self.text.len() - self.pos
    }

    /// The next word, on this line or a later one.
    pub fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_while(|byte| byte.is_ascii_whitespace());
        self.take()
    }

    /// The next word on this line.
    pub fn word_on_line(&mut self) -> Option<&'a [u8]> {
        self.skip_while(|byte| byte.is_ascii_whitespace() && byte != b'\n');
        self.take()
    }

    /// A number on this line.
    pub fn number(&mut self) -> Result<f64> {
        let word = self.word_on_line().ok_or_else(|| self.error("a number is missing"))?;
        parse_number(word).ok_or_else(|| self.error(format!("{} is not a number", quoted(word))))
    }

    /// A whole number on this line.
    pub fn integer(&mut self) -> Result<i64> {
        let word = self.word_on_line().ok_or_else(|| self.error("a whole number is missing"))?;
        parse_integer(word)
            .ok_or_else(|| self.error(format!("{} is not a whole number", quoted(word))))
    }

    /// The rest of this line, without its end; the scanner stands at the next.
    pub fn line(&mut self) -> Option<&'a [u8]> {
        if self.remaining() == 0 {
            return None;
        }
        let rest = &self.text[self.pos..];
        let length = rest.iter().position(|&byte| byte == b'\n').unwrap_or(rest.len());
        self.pos = (self.pos + length + 1).min(self.text.len());
        Some(rest[..length].strip_suffix(b"\r").unwrap_or(&rest[..length]))
    }

    /// Passes over lines that are empty or begin with `#`, and over the space before what follows.
    pub fn skip_comments(&mut self) {
        loop {
            self.skip_while(|byte| byte.is_ascii_whitespace());
            if self.text.get(self.pos) != Some(&b'#') {
                return;
            }
            self.line();
        }
    }

    /// What is wrong, with the line on which the scanner stands.
    pub fn error(&self, what: impl AsRef<str>) -> Error {
        // Counted only now: the good files never pay for it.
        let line = self.text[..self.pos].iter().filter(|&&byte| byte == b'\n').count() + 1;
        let end =
            if self.remaining() == 0 { ", at the end of the file; was it cut off?" } else { "" };
        error(self.format, format!("line {line}: {}{end}", what.as_ref()))
    }

    fn take(&mut self) -> Option<&'a [u8]> {
        let start = self.pos;
        self.skip_while(|byte| !byte.is_ascii_whitespace());
        (self.pos > start).then(|| &self.text[start..self.pos])
    }

    fn skip_while(&mut self, go_on: impl Fn(u8) -> bool) {
        let rest = &self.text[self.pos..];
        self.pos += rest.iter().position(|&byte| !go_on(byte)).unwrap_or(rest.len());
    }
}

/// A number as programs write it, Windows' NaN and infinities among them.
pub(super) fn parse_number(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| {
        let lower = text.to_ascii_lowercase();
        let odd = ["#inf", "#ind", "#qnan", "#snan", "nan(", "-nan", "+nan"];
        odd.iter().any(|odd| lower.contains(odd)).then_some(f64::NAN)
    })
}

/// A whole number; `3.0` is one, since some programs write all numbers alike.
pub(super) fn parse_integer(word: &[u8]) -> Option<i64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| {
        let number: f64 = text.parse().ok()?;
        (number.fract() == 0.0 && number.abs() < 1e15).then_some(number as i64)
    })
}

/// A word from the file, fit to be shown: short, and without what a terminal would obey.
pub(super) fn quoted(word: &[u8]) -> String {
    let shown = &word[..word.len().min(24)];
    let rest = if shown.len() < word.len() { "..." } else { "" };
    format!("\"{}{rest}\"", shown.escape_ascii())
}
