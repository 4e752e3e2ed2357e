//! Modules, what they define, and what they import or hand on.

use super::Source;
use super::tokens::{Token, tokens};
use std::collections::{BTreeMap, BTreeSet};

/// A path that a file names.
#[derive(Clone, Debug)]
pub(super) struct Mention {
    /// from the root of the crate
    pub(super) path: Vec<String>,
    pub(super) line: usize,
    pub(super) test: bool,
}

/// One name brought in by `use`.
#[derive(Clone, Debug)]
struct Import {
    path: Vec<String>,
    /// name here; `*` for all
    alias: String,
    line: usize,
    public: bool,
    test: bool,
}

#[derive(Debug, Default)]
struct Module {
    file: String,
    tokens: Vec<Token>,
    /// for each token, whether only tests see it
    test: Vec<bool>,
    /// for each token, modules inside the file that it stands in
    nested: Vec<usize>,
    imports: Vec<Import>,
    /// names of items at any depth
    defined: BTreeSet<String>,
}

/// All modules of the library and of the command.
pub(super) struct Names {
    modules: BTreeMap<Vec<String>, Module>,
}

impl Names {
    pub(super) fn of(sources: &[Source]) -> Self {
        let mut modules: BTreeMap<Vec<String>, Module> = sources
            .iter()
            .filter(|source| source.path.starts_with("src/") && source.path != "src/main.rs")
            .map(|source| (module_path(&source.path), Module::read(source)))
            .collect();
        mark_test_files(&mut modules);
        let known: BTreeSet<Vec<String>> = modules.keys().cloned().collect();
        for (path, module) in &mut modules {
            module.imports = imports(path, module, &known);
        }
        Self { modules }
    }

    /// Each file with its words that not only tests see.
    pub(super) fn production(&self) -> impl Iterator<Item = (&str, Vec<&Token>)> {
        self.modules.values().map(|module| {
            let words = module.tokens.iter().zip(&module.test);
            let seen = words.filter(|(_, test)| !**test).map(|(word, _)| word);
            (module.file.as_str(), seen.collect())
        })
    }

    /// What a file names: imports that it uses itself, and inline paths.
    pub(super) fn mentions(&self, file: &str) -> Vec<Mention> {
        let path = module_path(file);
        let Some(module) = self.modules.get(&path).filter(|m| m.file == file) else {
            return Vec::new();
        };
        let mut found: Vec<Mention> = module
            .imports
            .iter()
            .filter(|import| !import.public || module.uses(&import.alias))
            .map(|import| Mention {
                path: import.path.clone(),
                line: import.line,
                test: import.test,
            })
            .collect();
        found.extend(self.inline(&path, module));
        found
    }

    /// Paths outside of `use`.
    fn inline(&self, path: &[String], module: &Module) -> Vec<Mention> {
        let tokens = &module.tokens;
        let mut found = Vec::new();
        let mut i = 0;
        while i < tokens.len() {
            if tokens[i].text == "use" {
                i += tokens[i..].iter().take_while(|t| t.text != ";").count();
                continue;
            }
            // (`pub(in PATH)` says who may know, and names nothing)
            let is_visibility = i > 1 && tokens[i - 2].text == "(" && tokens[i - 1].text == "in";
            let starts = tokens[i].is_word()
                && !is_visibility
                && (i == 0 || tokens[i - 1].text != "::")
                && tokens.get(i + 1).is_some_and(|t| t.text == "::");
            if starts {
                let mut words = vec![tokens[i].text.clone()];
                let mut k = i + 1;
                while k + 1 < tokens.len() && tokens[k].text == "::" && tokens[k + 1].is_word() {
                    words.push(tokens[k + 1].text.clone());
                    k += 2;
                }
                let is_module = |p: &[String]| self.modules.contains_key(p);
                if let Some(absolute) = absolute(path, module.nested[i], &words, is_module) {
                    found.push(Mention {
                        path: absolute,
                        line: tokens[i].line,
                        test: module.test[i],
                    });
                }
                i = k;
            } else {
                i += 1;
            }
        }
        found
    }

    /// The file that defines what a path from the root names; `None` for nothing of this crate.
    pub(super) fn definition(&self, path: &[String]) -> Option<&str> {
        self.follow(path, 0)
    }

    fn follow(&self, path: &[String], depth: usize) -> Option<&str> {
        let known = (0..=path.len())
            .rev()
            .find(|&n| self.modules.contains_key(&path[..n]))?;
        let module = &self.modules[&path[..known]];
        let Some(name) = path.get(known) else {
            return Some(&module.file);
        };
        if depth > 8 || module.defined.contains(name) {
            return Some(&module.file);
        }
        if let Some(import) = module.imports.iter().find(|import| import.alias == *name) {
            return self.follow(&import.path, depth + 1);
        }
        for import in module.imports.iter().filter(|import| import.alias == "*") {
            let mut through = import.path.clone();
            if self
                .modules
                .get(&through)
                .is_some_and(|m| m.defined.contains(name))
            {
                through.push(name.clone());
                return self.follow(&through, depth + 1);
            }
        }
        Some(&module.file)
    }
}

impl Module {
    fn read(source: &Source) -> Self {
        let tokens = tokens(&source.text);
        let test = seen_by_tests_only(&tokens);
        let nested = nested_modules(&tokens);
        let keywords = [
            "struct",
            "enum",
            "trait",
            "fn",
            "const",
            "static",
            "type",
            "union",
            "macro_rules",
        ];
        let defined = tokens
            .windows(2)
            .filter(|pair| keywords.contains(&pair[0].text.as_str()) && pair[1].is_word())
            .map(|pair| pair[1].text.clone())
            .collect();
        Self {
            file: source.path.clone(),
            tokens,
            test,
            nested,
            imports: Vec::new(),
            defined,
        }
    }

    /// Whether the file itself uses a name that it imports.
    fn uses(&self, name: &str) -> bool {
        let mut in_use = false;
        let mut before = "";
        for token in &self.tokens {
            in_use = token.text == "use" || in_use && token.text != ";";
            if !in_use && token.text == name && !["::", "."].contains(&before) {
                return true;
            }
            before = &token.text;
        }
        false
    }
}

/// Path of the module that a file of `src` holds; `lib.rs` is the root.
fn module_path(file: &str) -> Vec<String> {
    let inside = file.strip_prefix("src/").unwrap_or(file);
    let mut path: Vec<String> = inside
        .trim_end_matches(".rs")
        .split('/')
        .map(str::to_owned)
        .collect();
    if path
        .last()
        .is_some_and(|last| last == "mod" || last == "lib")
    {
        path.pop();
    }
    path
}

/// The path from the root, of words that stand in a module and `nested` modules inside its file; `None` where
/// they name nothing of this crate.
fn absolute(
    module: &[String],
    nested: usize,
    words: &[String],
    is_module: impl Fn(&[String]) -> bool,
) -> Option<Vec<String>> {
    let mut base = module.to_vec();
    let mut inner = nested;
    let mut at = 0;
    match words[0].as_str() {
        // the command names the library by the crate's name
        "crate" | "coilwind" => {
            base.clear();
            at = 1;
        }
        "self" => {
            at = 1;
            if inner > 0 {
                return None;
            }
        }
        "super" => {
            while words.get(at).is_some_and(|word| word == "super") {
                if inner > 0 {
                    inner -= 1;
                } else {
                    base.pop()?;
                }
                at += 1;
            }
        }
        _ => {
            let mut child = base.clone();
            child.push(words[0].clone());
            if nested > 0 || !is_module(&child) {
                return None;
            }
        }
    }
    base.extend(words[at..].iter().cloned());
    Some(base)
}

/// Which tokens belong to an item under `#[cfg(test)]` or `#[cfg(doc)]`.
fn seen_by_tests_only(tokens: &[Token]) -> Vec<bool> {
    let mut test = vec![false; tokens.len()];
    let is = |i: usize, text: &str| tokens.get(i).is_some_and(|t: &Token| t.text == text);
    let mut i = 0;
    while i < tokens.len() {
        if !(is(i, "#") && is(i + 1, "[") && is(i + 2, "cfg")) {
            i += 1;
            continue;
        }
        let mut end = close(tokens, i + 1);
        let condition = &tokens[i + 3..end];
        let has = |word: &str| condition.iter().any(|t| t.text == word);
        if !(has("test") || has("doc")) || has("not") {
            i = end;
            continue;
        }
        while is(end + 1, "#") {
            end = close(tokens, end + 2);
        }
        let is_use = (1..4).any(|k| is(end + k, "use"));
        let mut k = end + 1;
        while k < tokens.len() && !is(k, ";") && (is_use || !is(k, "{")) {
            k += 1;
        }
        if is(k, "{") {
            k = close(tokens, k);
        }
        let last = k.min(tokens.len() - 1);
        test[i..=last].fill(true);
        i = last + 1;
    }
    test
}

/// Index of the bracket that closes the one at `open`.
fn close(tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (i, token) in tokens.iter().enumerate().skip(open) {
        match token.text.as_str() {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => {
                depth -= 1;
                if depth == 0 {
                    return i;
                }
            }
            _ => {}
        }
    }
    tokens.len() - 1
}

/// For each token, how many `mod NAME { }` of its file it stands in.
fn nested_modules(tokens: &[Token]) -> Vec<usize> {
    let mut nested = vec![0; tokens.len()];
    for i in 2..tokens.len() {
        if tokens[i].text == "{" && tokens[i - 2].text == "mod" {
            let end = close(tokens, i);
            nested[i..end].iter_mut().for_each(|depth| *depth += 1);
        }
    }
    nested
}

/// Files that are declared under `#[cfg(test)]` are code of tests from end to end.
fn mark_test_files(modules: &mut BTreeMap<Vec<String>, Module>) {
    let mut children = Vec::new();
    for (path, module) in modules.iter() {
        for (i, three) in module.tokens.windows(3).enumerate() {
            if three[0].text == "mod" && three[2].text == ";" && module.test[i] {
                let mut child = path.clone();
                child.push(three[1].text.clone());
                children.push(child);
            }
        }
    }
    for child in children {
        if let Some(module) = modules.get_mut(&child) {
            module.test.fill(true);
        }
    }
}

/// Every `use` of a file that names something of this crate.
fn imports(path: &[String], module: &Module, known: &BTreeSet<Vec<String>>) -> Vec<Import> {
    let tokens = &module.tokens;
    let mut found = Vec::new();
    for i in (0..tokens.len()).filter(|&i| tokens[i].text == "use") {
        let mut names = Vec::new();
        use_tree(tokens, i + 1, &[], &mut names);
        // `pub use` and `pub(crate) use` hand names on; behind a bracket stands the `)` of the latter
        let public = i > 0 && ["pub", ")"].contains(&tokens[i - 1].text.as_str());
        for (words, alias, line) in names {
            let Some(full) = absolute(path, module.nested[i], &words, |p| known.contains(p)) else {
                continue;
            };
            found.push(Import {
                path: full,
                alias,
                line,
                public,
                test: module.test[i],
            });
        }
    }
    found
}

/// Reads a tree of `use` from `at` and returns where it ends; names are (words, name here, line).
fn use_tree(
    tokens: &[Token],
    mut at: usize,
    before: &[String],
    names: &mut Vec<(Vec<String>, String, usize)>,
) -> usize {
    let mut words = before.to_vec();
    while let Some(token) = tokens.get(at) {
        match token.text.as_str() {
            "{" => {
                at += 1;
                while tokens.get(at).is_some_and(|t| t.text != "}") {
                    at = use_tree(tokens, at, &words, names);
                    at += usize::from(tokens.get(at).is_some_and(|t| t.text == ","));
                }
                return at + 1;
            }
            "*" => {
                names.push((words, "*".to_owned(), token.line));
                return at + 1;
            }
            "::" => at += 1,
            "self" if !words.is_empty() => at += 1,
            _ if token.is_word() => {
                words.push(token.text.clone());
                at += 1;
            }
            _ => return at,
        }
        let ends = tokens
            .get(at)
            .is_none_or(|t| [",", "}", ";", "as"].contains(&t.text.as_str()));
        if ends && words.len() > usize::from(before.is_empty()) {
            let line = token.line;
            let mut alias = words.last().cloned().unwrap_or_default();
            if tokens.get(at).is_some_and(|t| t.text == "as") {
                alias.clone_from(&tokens[at + 1].text);
                at += 2;
            }
            names.push((words, alias, line));
            return at;
        }
    }
    at
}
