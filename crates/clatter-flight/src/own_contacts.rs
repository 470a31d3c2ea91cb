//! Contacts of their own: feet, ends or corners that the ground answers otherwise than the others.

use clatter::Error;
use serde::{Deserialize, Serialize};

use crate::{Contact, ContactLaw};

/// A contact of its own; what is not given is that of the product.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct OwnContact {
    /// Coefficient of restitution.
    pub restitution: Option<f64>,
    /// How long a lone contact takes.
    pub contact_time_s: Option<f64>,
}

impl OwnContact {
    /// That of the product.
    pub const NONE: Self = Self { restitution: None, contact_time_s: None };
}

/// Which of the ends a and b of a bar, or of the corners a to d of a plate, have a contact of their own: a (−, −), b (+, −), c (+, +) and
/// d (−, +); of a box both corners, of the bottom and of the top, that are seen there from above.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct OwnContacts(pub [OwnContact; 4]);

/// The names of ends and corners.
pub const PLACES: [&str; 4] = ["a", "b", "c", "d"];

impl OwnContacts {
    /// All are those of the product.
    pub const NONE: Self = Self([OwnContact::NONE; 4]);

    /// Whether all are those of the product.
    #[must_use]
    pub fn is_none(&self) -> bool {
        *self == Self::NONE
    }
    /// Those that are there, with the names of their places.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, OwnContact)> + '_ {
        let own = |(_, own): &(&str, OwnContact)| *own != OwnContact::NONE;
        PLACES.into_iter().zip(self.0).filter(own)
    }
    /// Those that are there with restitution and contact time, where these are of the product.
    pub fn told(
        &self,
        restitution: f64,
        contact_time_s: Option<f64>,
    ) -> impl Iterator<Item = (&'static str, f64, Option<f64>)> + '_ {
        let one = move |(at, own): (&'static str, OwnContact)| {
            (at, own.restitution.unwrap_or(restitution), own.contact_time_s.or(contact_time_s))
        };
        self.given().map(one)
    }
    /// The same with length and width running the other way.
    #[must_use]
    pub fn mirrored(self, sides: [bool; 2]) -> Self {
        Self(std::array::from_fn(|k| self.0[image(k, sides)]))
    }
    /// Whether exchanging its ends, or its long edges, leaves them as they are.
    #[must_use]
    pub fn is_even(&self, sides: [bool; 2]) -> bool {
        self.mirrored(sides) == *self
    }
    /// The least and the largest restitution of a body with so many points, this one that of the product.
    #[must_use]
    pub fn restitutions(&self, points: usize, of_product: f64) -> [f64; 2] {
        ends(self.0[..points].iter().map(|own| own.restitution.unwrap_or(of_product)))
    }
    /// The shortest and the longest contact of a body with so many points, this one that of the product.
    #[must_use]
    pub fn contact_times_s(&self, points: usize, of_product: f64) -> [f64; 2] {
        ends(self.0[..points].iter().map(|own| own.contact_time_s.unwrap_or(of_product)))
    }
    /// The same with all restitutions changed alike.
    #[must_use]
    pub fn with_restitutions(self, of: impl Fn(f64) -> f64) -> Self {
        Self(self.0.map(|own| OwnContact { restitution: own.restitution.map(&of), ..own }))
    }
    /// The contacts of the corners of a box, in the order that a box has, this one that of the product.
    ///
    /// # Errors
    /// As [`Contact::new`].
    pub fn of_box(&self, of_product: &Contact) -> Result<[Contact; 8], Error> {
        let of: [Contact; 4] = self.contacts(of_product.law(), of_product.restitution(), of_product.time_s())?;
        Ok([0, 1, 3, 2, 0, 1, 3, 2].map(|corner| of[corner]))
    }
    /// The contacts of all points, these restitution and contact time those of the product.
    ///
    /// # Errors
    /// As [`Contact::new`].
    pub fn contacts<const N: usize>(
        &self,
        law: ContactLaw,
        restitution: f64,
        contact_time_s: f64,
    ) -> Result<[Contact; N], Error> {
        let mut contacts = [Contact::new(law, restitution, contact_time_s)?; N];
        for (contact, own) in contacts.iter_mut().zip(self.0).filter(|(_, own)| *own != OwnContact::NONE) {
            let time_s = own.contact_time_s.unwrap_or(contact_time_s);
            *contact = Contact::new(law, own.restitution.unwrap_or(restitution), time_s)?;
        }
        Ok(contacts)
    }
}

/// The end or corner that is k where sides run the other way.
fn image(k: usize, [along, across]: [bool; 2]) -> usize {
    let k = if along { [1, 0, 3, 2][k] } else { k };
    if across { 3 - k } else { k }
}

fn ends(values: impl Iterator<Item = f64>) -> [f64; 2] {
    values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, most], x| [least.min(x), most.max(x)])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn own(restitution: f64) -> OwnContact {
        OwnContact { restitution: Some(restitution), contact_time_s: None }
    }

    /// Seen from the other end a is b; over the long edge a is d.
    #[test]
    fn exchanged_sides_exchange_contacts() {
        let same = |got: &[f64], want: &[f64]| {
            let bits = |of: &[f64]| of.iter().map(|x| x.to_bits()).collect::<Vec<_>>();
            assert_eq!(bits(got), bits(want), "{got:?}, not {want:?}");
        };
        let all = OwnContacts([0.1, 0.2, 0.3, 0.4].map(own));
        let order = |of: OwnContacts| of.0.map(|own| own.restitution.unwrap_or(0.0));
        same(&order(all.mirrored([true, false])), &[0.2, 0.1, 0.4, 0.3]);
        same(&order(all.mirrored([false, true])), &[0.4, 0.3, 0.2, 0.1]);
        same(&order(all.mirrored([true, true])), &[0.3, 0.4, 0.1, 0.2]);
        let pairs = OwnContacts([own(0.1), own(0.2), own(0.2), own(0.1)]);
        assert!(pairs.is_even([false, true]) && !pairs.is_even([true, false]));
        let end = OwnContacts([OwnContact::NONE, own(0.2), OwnContact::NONE, OwnContact::NONE]);
        assert!(!end.is_even([true, false]));
        same(&end.restitutions(2, 0.5), &[0.2, 0.5]);
        // Both ends alike.
        let both = OwnContacts([own(0.2), own(0.2), OwnContact::NONE, OwnContact::NONE]);
        assert!(both.is_even([true, false]));
        same(&both.restitutions(2, 0.5), &[0.2; 2]);
    }
}
