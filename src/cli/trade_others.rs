//! `--points`: what other programs reach of the same picture, to be drawn beside our own choices.

use std::path::Path;

use super::failure::Failure;

/// Milliseconds a frame, decibels, and a name.
pub type Other = (f64, f64, String);

/// Reads lines of `name,milliseconds,decibels`; a first line of words is their heading.
pub fn read(path: &Path) -> Result<Vec<Other>, Failure> {
    let name = path.display();
    let text = std::fs::read_to_string(path).map_err(|error| {
        Failure::Said(format!(
            "{name}: cannot be read ({error}); name a file of lines such as `peer,20,41.5`"
        ))
    })?;
    let mut points = Vec::new();
    for (number, line) in (1..).zip(text.lines()).filter(|(_, line)| !line.trim().is_empty()) {
        match point(line) {
            Some(point) => points.push(point),
            None if number == 1 => {}
            None => {
                return Err(Failure::Said(format!(
                    "{name}: line {number} is no point; a name, milliseconds above 0 and decibels are expected, such as `peer,20,41.5`"
                )));
            }
        }
    }
    Ok(points)
}

fn point(line: &str) -> Option<Other> {
    let mut cells = line.rsplitn(3, ',').map(str::trim);
    let [psnr, milliseconds] = [cells.next()?, cells.next()?].map(|cell| cell.parse::<f64>().ok());
    let name = cells.next()?.trim_matches('"').to_owned();
    let milliseconds = milliseconds.filter(|ms| *ms > 0.0 && ms.is_finite())?;
    Some((milliseconds, psnr.filter(|psnr| psnr.is_finite())?, name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_is_a_name_a_time_and_decibels() {
        assert_eq!(
            point("\"VTK, 2 threads\", 70, 32.3"),
            Some((70.0, 32.3, "VTK, 2 threads".to_owned()))
        );
        for wrong in ["", "a", "a,1", "a,0,30", "a,x,30", "a,1,inf", "name,ms,psnr_db"] {
            assert_eq!(point(wrong), None, "{wrong}");
        }
    }
}
