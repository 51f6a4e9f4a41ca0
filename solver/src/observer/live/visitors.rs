//! `Visitors`: who may look on, as a web page of anywhere can reach the servers of whoever reads it.

use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

use tungstenite::handshake::server::Request;
use tungstenite::http::HeaderName;
use tungstenite::http::header::{HOST, ORIGIN};

/// Characters of a name that are reported.
const SHOWN: usize = 100;

/// Names by which this server may be called, and pages that may do so.
///
/// A browser says in `Origin` which page connects; programs other than browsers need not. A page whose name its
/// owner lets stand for this machine's address (DNS rebinding) is known by `Host`, which is that name.
#[derive(Debug, Default)]
pub struct Visitors {
    /// Origins that are allowed, besides those of this machine.
    origins: Vec<String>,
    /// Their hosts, in small letters.
    hosts: Vec<String>,
    /// Whether other machines connect: by its address, as a name could be anybody's.
    takes_addresses: bool,
}

impl Visitors {
    /// Those of a server at an address, and of origins such as `https://viewer.example`, or names of hosts.
    #[must_use]
    pub fn new(address: SocketAddr, origins: &[String]) -> Self {
        let tidy = |text: &String| text.trim().trim_end_matches('/').to_ascii_lowercase();
        let origins: Vec<String> = origins.iter().map(tidy).collect();
        let authority = |origin: &String| match origin.split_once("://") {
            Some((_, authority)) => authority.to_owned(),
            None => origin.clone(),
        };
        let hosts = origins.iter().filter_map(|one| Some(host_of(&authority(one))?.to_owned()));
        let hosts = hosts.collect();
        Self { origins, hosts, takes_addresses: !address.ip().is_loopback() }
    }

    /// Whether a request may be answered.
    ///
    /// # Errors
    /// Why it may not, in a line.
    pub fn check(&self, request: &Request) -> Result<(), String> {
        let hosts = values(request, &HOST)?;
        let [host] = hosts[..] else { return Err("a request names one Host".to_owned()) };
        let name = host_of(host).unwrap_or_default().to_ascii_lowercase();
        if !self.is_name_of_this(&name) {
            return Err(format!("Host {} is no name of this machine", shown(host)));
        }
        for origin in values(request, &ORIGIN)? {
            if !self.is_allowed(&origin.to_ascii_lowercase()) {
                return Err(format!("pages of {} may not look on", shown(origin)));
            }
        }
        Ok(())
    }

    fn is_name_of_this(&self, host: &str) -> bool {
        let is_address = || self.takes_addresses && address_of(host).is_some();
        is_loopback(host) || is_address() || self.hosts.iter().any(|own| own == host)
    }

    fn is_allowed(&self, origin: &str) -> bool {
        if self.origins.iter().any(|own| own == origin) {
            return true;
        }
        let Some((scheme, authority)) = origin.split_once("://") else { return false };
        let Some(host) = host_of(authority) else { return false };
        let is_named = || self.origins.iter().any(|own| own == authority || own == host);
        ["http", "https"].contains(&scheme) && (is_loopback(host) || is_named())
    }
}

/// The values of a header.
fn values<'a>(request: &'a Request, name: &HeaderName) -> Result<Vec<&'a str>, String> {
    let all = request.headers().get_all(name).into_iter();
    all.map(|value| value.to_str().map_err(|_| format!("{name} is no text"))).collect()
}

/// The host of `host` or `host:port`; nothing where it is neither.
fn host_of(authority: &str) -> Option<&str> {
    let is_port = |text: &str| text.parse::<u16>().is_ok();
    let host = match authority.rfind(']') {
        Some(end) => {
            let rest = &authority[end + 1..];
            let is_whole = rest.is_empty() || rest.strip_prefix(':').is_some_and(is_port);
            authority.starts_with('[').then_some(&authority[..=end]).filter(|_| is_whole)
        }
        None => match authority.split_once(':') {
            Some((host, port)) => Some(host).filter(|_| is_port(port)),
            None => Some(authority),
        },
    }?;
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "-._[]:".contains(c);
    (!host.is_empty() && host.chars().all(is_plain)).then_some(host)
}

fn address_of(host: &str) -> Option<IpAddr> {
    match host.strip_prefix('[').and_then(|rest| rest.strip_suffix(']')) {
        Some(inner) => inner.parse::<Ipv6Addr>().ok().map(IpAddr::V6),
        None => host.parse::<Ipv4Addr>().ok().map(IpAddr::V4),
    }
}

/// Whether a name stands for this machine wherever it is looked up.
fn is_loopback(host: &str) -> bool {
    host == "localhost" || address_of(host).is_some_and(|address| address.is_loopback())
}

fn shown(text: &str) -> String {
    format!("{:?}", text.chars().take(SHOWN).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    const HERE: &str = "127.0.0.1:8765";

    fn is_let_in(address: &str, origins: &[&str], host: &str, origin: Option<&str>) -> bool {
        let origins: Vec<String> = origins.iter().map(|one| (*one).to_owned()).collect();
        let visitors = Visitors::new(address.parse().unwrap(), &origins);
        let request = Request::builder().uri("/").header(HOST, host);
        let request = match origin {
            Some(origin) => request.header(ORIGIN, origin),
            None => request,
        };
        visitors.check(&request.body(()).unwrap()).is_ok()
    }

    #[test]
    fn this_machine_alone_is_let_in() {
        for host in ["localhost", "localhost:8765", "LOCALHOST", HERE, "127.8.0.1", "[::1]:1"] {
            assert!(is_let_in(HERE, &[], host, None), "{host}");
            for scheme in ["http", "https"] {
                assert!(is_let_in(HERE, &[], HERE, Some(&format!("{scheme}://{host}"))), "{host}");
            }
        }
        let foreign = [
            "evil.example",
            "localhost.evil.example",
            "evil.example:8765",
            "127.0.0.1.evil.example",
            "localhost@evil.example",
            "localhost:80@evil.example",
            "192.168.0.1",
            "[::2]",
            "[::1]evil.example",
            "0.0.0.0",
            "localhost.",
            "127.1",
            "",
        ];
        for host in foreign {
            assert!(!is_let_in(HERE, &[], host, None), "{host}");
            let origin = format!("http://{host}");
            assert!(!is_let_in(HERE, &[], HERE, Some(&origin)), "{origin}");
        }
        for origin in ["null", "file://", "", "ftp://localhost", "localhost", "http://localhost/a"]
        {
            assert!(!is_let_in(HERE, &[], HERE, Some(origin)), "{origin}");
        }
    }

    #[test]
    fn others_are_let_in_by_name() {
        let allowed = ["https://viewer.example/", "node7:8080"];
        for (origin, is_right) in [
            ("https://viewer.example", true),
            ("https://VIEWER.example", true),
            ("http://viewer.example", false),
            ("https://viewer.example:444", false),
            ("http://node7:8080", true),
            ("http://node7", false),
        ] {
            assert_eq!(is_let_in(HERE, &allowed, HERE, Some(origin)), is_right, "{origin}");
        }
        assert!(is_let_in(HERE, &allowed, "viewer.example:8765", None));
        assert!(is_let_in(HERE, &allowed, "node7:8765", None));
        assert!(!is_let_in(HERE, &allowed, "node8:8765", None));
        // Of an address that other machines reach, addresses are names that nobody else can take
        assert!(is_let_in("0.0.0.0:8765", &[], "192.168.0.1:8765", None));
        assert!(!is_let_in("0.0.0.0:8765", &[], "evil.example:8765", None));
        assert!(!is_let_in("0.0.0.0:8765", &[], "192.168.0.1:8765", Some("http://192.168.0.1")));
    }

    #[test]
    fn one_host_is_named() {
        let visitors = Visitors::new(HERE.parse().unwrap(), &[]);
        let none = Request::builder().uri("/").body(()).unwrap();
        assert!(visitors.check(&none).is_err());
        let two = Request::builder().header(HOST, HERE).header(HOST, "evil.example");
        assert!(visitors.check(&two.body(()).unwrap()).is_err());
    }
}
