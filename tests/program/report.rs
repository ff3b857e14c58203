//! `gelray report`: one page that needs nothing but itself, made in parts that stay.

use super::Place;

/// Every value of an attribute in a page.
fn values<'a>(page: &'a str, attribute: &str) -> Vec<&'a str> {
    let begins = format!(" {attribute}=\"");
    page.split(&begins[..]).skip(1).filter_map(|rest| rest.split('"').next()).collect()
}

fn is_self_contained(page: &str) {
    assert!(!page.contains("http") && !page.contains("url(") && !page.contains("@import"));
    assert!(
        !page.contains("<link") && !page.contains("<script") && values(page, "href").is_empty()
    );
    let sources = values(page, "src");
    assert!(!sources.is_empty());
    assert!(sources.iter().all(|source| source.starts_with("data:image/png;base64,")));
}

#[test]
fn a_report_is_one_page_with_all_figures_and_goes_on_where_it_was_stopped() {
    let place = Place::new();
    let words = "report -o r --figures minimal_3,minimal_4 --size 20x16 --quick --points peers.csv";
    place.write("peers.csv", "name,ms,psnr_db\nVTK, 2 threads,70,32.3\n");
    place.done(words);
    let page = String::from_utf8(place.read("r/index.html")).unwrap();
    is_self_contained(&page);
    let figures = ["id=\"minimal_3\"", "id=\"minimal_4\"", "<svg", "every ray"];
    for part in figures.into_iter().chain(["60 s classifying", "VTK, 2 threads", "(§4): 1"]) {
        assert!(page.contains(part), "{part}");
    }
    let titles = ["Where the time goes", "The paper's numbers", "Speed against accuracy"];
    for title in titles.into_iter().chain(["Figures", "How cost grows"]) {
        assert!(page.contains(&format!("<h2>{title}</h2>")), "{title}");
    }
    let parts =
        ["minimal_3.json", "minimal_4.png", "growth.json", "exact.json", "trade/trade.json"];
    let before = parts.map(|part| place.read(&format!("r/parts/{part}")));
    // What is kept is taken as it is: its times too.
    std::fs::remove_file(place.path("r/parts/exact.png")).unwrap();
    place.done(&format!("{words} --resume"));
    let after = parts.map(|part| place.read(&format!("r/parts/{part}")));
    assert_eq!(before[..3], after[..3]);
    assert!(place.path("r/parts/exact.png").exists());
}

#[test]
fn a_trade_s_page_needs_nothing_but_itself_and_draws_what_others_reach() {
    let place = Place::new();
    place.write("peers.csv", "name,ms,psnr_db\nVTK, 2 threads,70,32.3\n");
    let words = "trade cross.toml -o t --size 24x20 --repeat 1 --combinations 1";
    place.done(&format!("{words} --points peers.csv"));
    let page = String::from_utf8(place.read("t/index.html")).unwrap();
    is_self_contained(&page);
    assert!(page.contains("VTK, 2 threads"));
    place.write("wrong.csv", "name,ms,psnr_db\nVTK,fast,32.3\n");
    place.refused(&format!("{words} --points wrong.csv"), 1, &["wrong.csv", "line 2"]);
}

#[test]
fn a_report_is_refused_in_a_sentence() {
    let place = Place::new();
    place.refused("report", 2, &["needs a folder", "-o DIR"]);
    place.refused("report -o r --figures nothing", 2, &["gelray scenes"]);
    place.refused("report -o r --exact", 2, &["no use for --exact"]);
    place.refused("report -o cross.toml", 1, &["cross.toml", "cannot be made"]);
}
